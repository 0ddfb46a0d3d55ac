"""Cell voltages and probe temperatures: complete sets, how they are split and put together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeVar

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import B2V_Temp, B2V_Ucell
from typedcan.transfer import Assembler, Reading, Readings, split
from typedcan.wire.protocol import Transfer

CELL_VOLTAGES = PROTOCOL.transfer("cell_voltages")
PROBE_TEMPERATURES = PROTOCOL.transfer("probe_temperatures")

_ReadingsT = TypeVar("_ReadingsT", bound=Readings)


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
    return tuple(each for each in split(CELL_VOLTAGES, cells) if isinstance(each, B2V_Ucell))


def split_probe_temperatures(probes: Mapping[int, Sequence[Reading]]) -> tuple[B2V_Temp, ...]:
    """The frames of one cycle from the probe temperatures of each CSC, in degC.

    A CSC without probes takes no frame. What a CSC's last frame has no probe for is INVALID.
    Raises `TransferError`.
    """
    return tuple(each for each in split(PROBE_TEMPERATURES, probes) if isinstance(each, B2V_Temp))


class CellAssembler(Assembler[CellVoltages]):
    """Puts the cell voltages of all CSCs together; none is older than ``window`` seconds."""

    def __init__(self, *, window: float | None = None, transfer: Transfer = CELL_VOLTAGES) -> None:
        super().__init__(transfer, cell_voltages, timeout=window)


class ProbeAssembler(Assembler[ProbeTemperatures]):
    """Puts the probe temperatures of all CSCs together; none is older than ``window`` seconds."""

    def __init__(
        self, *, window: float | None = None, transfer: Transfer = PROBE_TEMPERATURES
    ) -> None:
        super().__init__(transfer, probe_temperatures, timeout=window)


def cell_voltages(readings: Readings) -> CellVoltages:
    """The readings as what they are here."""
    return _called(CellVoltages, readings)


def probe_temperatures(readings: Readings) -> ProbeTemperatures:
    """The readings as what they are here."""
    return _called(ProbeTemperatures, readings)


def _called(kind: type[_ReadingsT], readings: Readings) -> _ReadingsT:
    groups = {group: tuple(values.values()) for group, values in readings.items()}
    return kind(groups, readings.at, readings.transfer)
