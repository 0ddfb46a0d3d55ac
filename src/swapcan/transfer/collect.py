"""All transfers of the standard that a node receives, behind one door."""

from __future__ import annotations

from swapcan.transfer.readings import (
    CELL_VOLTAGES,
    PROBE_TEMPERATURES,
    CellAssembler,
    CellVoltages,
    ProbeAssembler,
    ProbeTemperatures,
)
from swapcan.transfer.text import PACK_CODE, VIN, PackCode, Vin
from swapcan.transfer.text_assembly import PackCodeAssembler, VinAssembler
from typedcan.transfer import collect
from typedcan.transfer.problem import Problem
from typedcan.wire.protocol import Protocol

Assembler = VinAssembler | PackCodeAssembler | CellAssembler | ProbeAssembler

Outcome = Vin | PackCode | CellVoltages | ProbeTemperatures | Problem
"""What a message can bring about."""


class Transfers(collect.Transfers):
    """The assemblers of one node; one thread at a time.

    Parameters
    ----------
    protocol
        Its transfers named vin, pack_code, cell_voltages and probe_temperatures are put together.
    check_vin
        Whether a VIN must be one after ISO 3779, check digit included.
    """

    def __init__(self, protocol: Protocol, *, check_vin: bool = False) -> None:
        super().__init__(
            protocol,
            {
                VIN.name: lambda transfer: VinAssembler(check=check_vin, transfer=transfer),
                PACK_CODE.name: lambda transfer: PackCodeAssembler(transfer=transfer),
                CELL_VOLTAGES.name: lambda transfer: CellAssembler(transfer=transfer),
                PROBE_TEMPERATURES.name: lambda transfer: ProbeAssembler(transfer=transfer),
            },
        )
