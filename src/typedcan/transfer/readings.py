"""Readings by group: a complete set, and how one is split into frames."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any, ClassVar

from typedcan.transfer.layout import create, group_word
from typedcan.wire.errors import EncodeError, TransferError
from typedcan.wire.message import Field, MessageT, SignalState
from typedcan.wire.protocol import FieldRef, Transfer

Reading = float | SignalState
"""A measured value, or what the signal says instead."""


class Readings(Mapping[int, Mapping[int, Reading]]):
    """A complete set of readings: ``readings[group][n]``, both counted from 1; read-only.

    As a mapping it has the groups; two are equal when all their readings are.

    Parameters
    ----------
    groups
        The readings of each group in order.
    at
        When the set was complete, in seconds.
    """

    __slots__ = ("_groups", "_numbered", "at")

    GROUPS: ClassVar[str] = "groups"
    """What the groups are called."""

    def __init__(self, groups: Mapping[int, Sequence[Reading]], at: float) -> None:
        self._groups = {group: tuple(values) for group, values in groups.items()}
        self._numbered: dict[int, Mapping[int, Reading]] = {}  # those that were asked for
        self.at = at

    def __getitem__(self, group: int) -> Mapping[int, Reading]:
        if group not in self._numbered:
            numbered = dict(enumerate(self._groups[group], 1))
            self._numbered[group] = MappingProxyType(numbered)
        return self._numbered[group]

    def __iter__(self) -> Iterator[int]:
        return iter(self._groups)

    def __len__(self) -> int:
        return len(self._groups)

    def __repr__(self) -> str:
        counts = f"{self.count} readings of {len(self)} {self.GROUPS}"
        return f"<{type(self).__name__}: {counts} at {self.at:g} s>"

    @property
    def count(self) -> int:
        """How many readings there are in all groups together."""
        return sum(map(len, self._groups.values()))

    def flat(self) -> tuple[Reading, ...]:
        """All readings, group by group."""
        return tuple(reading for group in self._groups.values() for reading in group)


def split_readings(
    transfer: Transfer, kind: type[MessageT], groups: Mapping[int, Sequence[Reading]]
) -> tuple[MessageT, ...]:
    """The frames of one cycle from the readings of each group; raises `TransferError`.

    A group without readings takes no frame. What a group's last frame has none for is INVALID.
    """
    return tuple(
        create(kind, values)
        for group in sorted(groups)
        for values in _group_frames(transfer, group, groups[group])
    )


def _group_frames(
    transfer: Transfer, group: int, readings: Sequence[Reading]
) -> Iterator[dict[str, Any]]:
    """The fields of each frame of a group."""
    word = group_word(transfer)
    last_group = _highest(_field(transfer.group))
    if not 1 <= group <= last_group:
        raise TransferError(
            transfer.name, f"{word} {group}; {word}s are numbered 1 to {last_group}"
        )
    fields = [item.field for item in transfer.items]
    last_number = _highest(_field(transfer.frame_number))
    if len(readings) > last_number * len(fields):
        problem = f"{word} {group} has {len(readings)} readings, {last_number} frames have no room"
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
        problem = f"{group_word(transfer)} {group} number {position + 1}: {error.problem}"
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
