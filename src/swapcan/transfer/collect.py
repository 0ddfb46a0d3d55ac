"""All transfers of the standard that a node receives, behind one door."""

from __future__ import annotations

from swapcan.transfer.readings import (
    CELL_VOLTAGES,
    PROBE_TEMPERATURES,
    CellVoltages,
    ProbeTemperatures,
    cell_voltages,
    probe_temperatures,
)
from swapcan.transfer.text import (
    PACK_CODE,
    VIN,
    PackCode,
    Vin,
    any_vin,
    checked_vin,
    pack_code,
)
from typedcan import transfer
from typedcan.transfer import Problem
from typedcan.wire.protocol import Protocol

Outcome = Vin | PackCode | CellVoltages | ProbeTemperatures | Problem
"""What a message can bring about."""


class Transfers(transfer.Transfers):
    """The assemblers of one node; one thread at a time.

    Parameters
    ----------
    protocol
        Its transfers; those of this standard become `Vin`, `PackCode`, `CellVoltages` and
        `ProbeTemperatures`.
    check_vin
        Whether a VIN must be one after ISO 3779, check digit included.
    """

    def __init__(self, protocol: Protocol, *, check_vin: bool = False) -> None:
        super().__init__(
            protocol,
            {
                VIN.name: (Vin, checked_vin if check_vin else any_vin),
                PACK_CODE.name: (PackCode, pack_code),
                CELL_VOLTAGES.name: (CellVoltages, cell_voltages),
                PROBE_TEMPERATURES.name: (ProbeTemperatures, probe_temperatures),
            },
        )
