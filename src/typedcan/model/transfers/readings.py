"""Readings by group: measured values of many sensors, some in a frame, group by group."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, ClassVar

from typedcan.model.signal_state import SignalState
from typedcan.model.transfer import Numbering
from typedcan.model.transfers.cycle import NUMBER_BITS
from typedcan.model.transfers.kind import (
    MOST_ITEMS,
    Frame,
    Kind,
    SplitError,
    Unfit,
    one_count,
    one_message,
    whole_numbers,
)
from typedcan.model.transfers.parts import Part, Parts
from typedcan.model.transfers.reading_rules import Reading, ReadingRules, Readings
from typedcan.model.transfers.shape import numbered_through


class ReadingsByGroup(Kind):
    """Readings of groups."""

    name = "readings_by_group"
    purpose = "measured values of many sensors, group by group, in numbered frames"
    value = Readings
    takes: ClassVar[frozenset[str]] = frozenset(
        {
            *("frame_number", "first_number", "numbering", "group", "first_group"),
            *("groups", "groups_signal", "count", "count_signal", "counts", "fill", "column"),
        }
    )
    needs = ("frame_number", "group")

    def own_problems(self, parts: Parts) -> Iterator[Unfit]:
        """What does not fit."""
        transfer = parts.transfer
        yield from one_message(parts)
        yield from whole_numbers(parts, "frame_number", "group", "count_signal", "groups_signal")
        if not parts.items:
            yield Unfit("items", "missing")
        if parts.period is None:
            yield Unfit("period", "missing: its message has none, and readings grow old by it")
        if transfer.first_group not in (0, 1):
            yield Unfit("first_group", "groups are numbered from 0 or from 1")
        for key, part in (("frame_number", parts.number), ("group", parts.group)):
            if part and part.signal.length > NUMBER_BITS:
                yield Unfit(key, f"{part.signal.name} has more than {NUMBER_BITS} bits")
        if transfer.counts:
            yield from _bad_counts(parts)
        else:
            yield from one_count(transfer, "count", "count_signal")
            yield from one_count(transfer, "groups", "groups_signal")

    def rules(
        self, parts: Parts, timeout: float | None = None, rounds: int | None = None
    ) -> ReadingRules:
        """What puts the readings together; each cycle counts, so there are no rounds."""
        del rounds
        return ReadingRules(parts, timeout)

    def split(self, parts: Parts, value: Any) -> list[Frame]:
        """The frames of one cycle from the readings of each group.

        A group without readings takes no frame. What a group's last frame has none for holds the
        fill, or is INVALID.
        """
        groups: Mapping[int, Sequence[Reading]] = (
            {group: tuple(value[group].values()) for group in value}
            if isinstance(value, Readings)
            else value
        )
        counts = dict(enumerate(parts.transfer.counts, parts.transfer.first_group))
        for group in sorted({*counts, *groups} if counts else ()):
            there, known = len(groups.get(group, ())), counts.get(group, 0)
            if there != known:
                raise SplitError(f"{parts.word} {group} has {known} readings, not {there}")
        before: Mapping[int, int] = {}
        if parts.transfer.numbering is Numbering.THROUGH:
            own = {group: len(readings) for group, readings in groups.items()}
            before = numbered_through(own, parts.width)
        return [
            frame
            for group in sorted(groups)
            for frame in _split_group(parts, group, before.get(group, 0), groups[group])
        ]


def _split_group(
    parts: Parts, group: int, before: int, readings: Sequence[Reading]
) -> Iterator[Frame]:
    """The frames of a group; ``before`` is how many frame numbers are those of other groups."""
    transfer, number, own = parts.transfer, parts.number, parts.group
    if number is None or own is None:
        raise SplitError("frames are not numbered group by group")
    word = parts.word
    if not transfer.first_group <= group <= own.highest:
        named = f"{word}s are numbered {transfer.first_group} to {own.highest}"
        raise SplitError(f"{word} {group}; {named}")
    room = number.highest - transfer.first_number + 1 - before
    if len(readings) > room * parts.width:
        problem = f"{word} {group} has {len(readings)} readings, {room} frames have no room"
        raise SplitError(problem)
    for frame, start in enumerate(range(0, len(readings), parts.width)):
        values: dict[str, Any] = {}
        called: dict[str, str] = {}
        for position, part in enumerate(parts.items, start):
            name = part.signal.name
            values[name] = _fill_of(parts, part)
            if position < len(readings):
                values[name] = readings[position]
                called[name] = f"{word} {group} number {position + 1}"
        values[own.signal.name] = group
        values[number.signal.name] = transfer.first_number + before + frame
        yield Frame(number.message.name, values, called)


def _fill_of(parts: Parts, part: Part) -> Reading:
    """What an item holds that is not used."""
    fill = parts.transfer.fill
    return SignalState.INVALID if fill is None else part.value_of(fill)


def _bad_counts(parts: Parts) -> Iterator[Unfit]:
    """What is wrong with the fixed numbers of readings of each group."""
    transfer = parts.transfer
    for key in ("groups", "groups_signal", "count", "count_signal"):
        if getattr(transfer, key):
            yield Unfit(key, "`counts` tells it already")
    if any(count < 0 for count in transfer.counts) or not 0 < sum(transfer.counts) <= MOST_ITEMS:
        yield Unfit("counts", f"do not add up to 1 to {MOST_ITEMS}")
    last = transfer.first_group + len(transfer.counts) - 1
    if parts.group and last > parts.group.highest:
        yield Unfit("counts", f"there are groups up to {parts.group.highest} only")
