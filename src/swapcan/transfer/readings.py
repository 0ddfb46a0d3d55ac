"""Cell voltages and probe temperatures: a complete set, and how one is split into frames."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import B2V_Temp, B2V_Ucell
from swapcan.transfer.layout import create
from typedcan.wire.errors import EncodeError, TransferError
from typedcan.wire.message import Field, MessageT, SignalState
from typedcan.wire.protocol import FieldRef, Transfer

Reading = float | SignalState
"""A measured value, or what the signal says instead."""

CELL_VOLTAGES = PROTOCOL.transfer("cell_voltages")
PROBE_TEMPERATURES = PROTOCOL.transfer("probe_temperatures")


class Readings(Mapping[int, Mapping[int, Reading]]):
    """A complete set of readings: ``readings[csc][n]``, both counted from 1; read-only.

    As a mapping it has the CSCs; two are equal when all their readings are.

    Parameters
    ----------
    groups
        The readings of each CSC in order.
    at
        When the set was complete, in seconds.
    """

    __slots__ = ("_groups", "_numbered", "at")

    def __init__(self, groups: Mapping[int, Sequence[Reading]], at: float) -> None:
        self._groups = {group: tuple(values) for group, values in groups.items()}
        self._numbered: dict[int, Mapping[int, Reading]] = {}  # those that were asked for
        self.at = at

    def __getitem__(self, csc: int) -> Mapping[int, Reading]:
        if csc not in self._numbered:
            numbered = dict(enumerate(self._groups[csc], 1))
            self._numbered[csc] = MappingProxyType(numbered)
        return self._numbered[csc]

    def __iter__(self) -> Iterator[int]:
        return iter(self._groups)

    def __len__(self) -> int:
        return len(self._groups)

    def __repr__(self) -> str:
        counts = f"{self.count} readings of {len(self)} CSCs"
        return f"<{type(self).__name__}: {counts} at {self.at:g} s>"

    @property
    def count(self) -> int:
        """How many readings there are in all CSCs together."""
        return sum(map(len, self._groups.values()))

    def flat(self) -> tuple[Reading, ...]:
        """All readings, CSC by CSC."""
        return tuple(reading for group in self._groups.values() for reading in group)


class CellVoltages(Readings):
    """The voltage of every cell, in V."""

    __slots__ = ()


class ProbeTemperatures(Readings):
    """The temperature of every probe, in degC."""

    __slots__ = ()


def split_cell_voltages(cells: Mapping[int, Sequence[Reading]]) -> tuple[B2V_Ucell, ...]:
    """The frames of one cycle from the cell voltages of each CSC, in V; raises `TransferError`.

    A CSC without cells takes no frame. What a CSC's last frame has no cell for is INVALID.
    """
    return _split(CELL_VOLTAGES, B2V_Ucell, cells)


def split_probe_temperatures(probes: Mapping[int, Sequence[Reading]]) -> tuple[B2V_Temp, ...]:
    """The frames of one cycle from the probe temperatures of each CSC, in degC.

    A CSC without probes takes no frame. What a CSC's last frame has no probe for is INVALID.
    Raises `TransferError`.
    """
    return _split(PROBE_TEMPERATURES, B2V_Temp, probes)


def _split(
    transfer: Transfer, kind: type[MessageT], groups: Mapping[int, Sequence[Reading]]
) -> tuple[MessageT, ...]:
    return tuple(
        create(kind, values)
        for group in sorted(groups)
        for values in _group_frames(transfer, group, groups[group])
    )


def _group_frames(
    transfer: Transfer, group: int, readings: Sequence[Reading]
) -> Iterator[dict[str, Any]]:
    """The fields of each frame of a CSC."""
    last_group = _highest(_field(transfer.group))
    if not 1 <= group <= last_group:
        raise TransferError(transfer.name, f"CSC {group}; CSCs are numbered 1 to {last_group}")
    fields = [item.field for item in transfer.items]
    last_number = _highest(_field(transfer.frame_number))
    if len(readings) > last_number * len(fields):
        problem = f"CSC {group} has {len(readings)} readings, {last_number} frames have no room"
        raise TransferError(transfer.name, problem)
    for number, start in enumerate(range(0, len(readings), len(fields)), 1):
        values: dict[str, Any] = dict.fromkeys(fields, SignalState.INVALID)
        for position, item in enumerate(transfer.items[: len(readings) - start], start):
            values[item.field] = _checked(transfer, item, group, position, readings[position])
        yield {**values, **_numbers(transfer, group, number)}


def _numbers(transfer: Transfer, group: int, number: int) -> dict[str, int]:
    refs = ((transfer.group, group), (transfer.frame_number, number))
    return {ref.field: value for ref, value in refs if ref}


def _checked(
    transfer: Transfer, item: FieldRef, group: int, position: int, reading: Reading
) -> Reading:
    try:
        item.message.FIELDS[item.field].to_raw(item.message.NAME, reading)
    except EncodeError as error:
        problem = f"CSC {group} number {position + 1}: {error.problem}"
        raise TransferError(transfer.name, problem) from None
    return reading


def _field(ref: FieldRef | None) -> Field:
    if ref is None:
        raise LookupError("the transfer numbers no frames within groups")
    return ref.message.FIELDS[ref.field]


def _highest(field: Field) -> int:
    """The highest number of a field that is not a code for something else."""
    highest = int(field.maximum)
    while highest in field.states:
        highest -= 1
    return highest
