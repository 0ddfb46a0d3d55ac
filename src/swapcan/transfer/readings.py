"""Cell voltages and probe temperatures: complete sets, how they are split and put together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import B2V_Temp, B2V_Ucell
from typedcan.transfer.reading_assembly import ReadingsAssembler
from typedcan.transfer.readings import Reading, Readings, split_readings
from typedcan.wire.protocol import Transfer

CELL_VOLTAGES = PROTOCOL.transfer("cell_voltages")
PROBE_TEMPERATURES = PROTOCOL.transfer("probe_temperatures")

TABLES = {"cell_voltages": ("cells", "cell"), "probe_temperatures": ("probes", "probe")}
"""What the tables of transfers, and one reading, are called in columns."""


class CellVoltages(Readings):
    """The voltage of every cell, in V."""

    __slots__ = ()

    GROUPS = "CSCs"


class ProbeTemperatures(Readings):
    """The temperature of every probe, in degC."""

    __slots__ = ()

    GROUPS = "CSCs"


def split_cell_voltages(cells: Mapping[int, Sequence[Reading]]) -> tuple[B2V_Ucell, ...]:
    """The frames of one cycle from the cell voltages of each CSC, in V; raises `TransferError`.

    A CSC without cells takes no frame. What a CSC's last frame has no cell for is INVALID.
    """
    return split_readings(CELL_VOLTAGES, B2V_Ucell, cells)


def split_probe_temperatures(probes: Mapping[int, Sequence[Reading]]) -> tuple[B2V_Temp, ...]:
    """The frames of one cycle from the probe temperatures of each CSC, in degC.

    A CSC without probes takes no frame. What a CSC's last frame has no probe for is INVALID.
    Raises `TransferError`.
    """
    return split_readings(PROBE_TEMPERATURES, B2V_Temp, probes)


class CellAssembler(ReadingsAssembler[CellVoltages]):
    """Puts the cell voltages of all CSCs together."""

    def __init__(self, *, window: float | None = None, transfer: Transfer = CELL_VOLTAGES) -> None:
        super().__init__(transfer, CellVoltages, window)


class ProbeAssembler(ReadingsAssembler[ProbeTemperatures]):
    """Puts the probe temperatures of all CSCs together."""

    def __init__(
        self, *, window: float | None = None, transfer: Transfer = PROBE_TEMPERATURES
    ) -> None:
        super().__init__(transfer, ProbeTemperatures, window)
