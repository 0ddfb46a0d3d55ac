"""When readings by group are complete, and what is wrong with what comes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any, ClassVar

from typedcan.model.signal_state import SignalState
from typedcan.model.transfers.cycle import (
    KEPT,
    NUMBER_BITS,
    NUMBERS,
    WINDOW,
    Cycle,
    Outcome,
    key_of,
)
from typedcan.model.transfers.kind import Problem, ProblemKind, Rules, whole
from typedcan.model.transfers.parts import Parts
from typedcan.model.transfers.shape import Totals, frames_of, shape_of, totals_of

Reading = float | SignalState
"""A measured value, or what the signal says instead."""

_NAMED = 3
"""How many missing frames are named one by one."""


class Readings(Mapping[int, Mapping[int, Reading]]):
    """A complete set of readings: ``readings[group][n]``, n counted from 1; read-only.

    As a mapping it has the groups; two are equal when all their readings are.

    Parameters
    ----------
    groups
        The readings of each group in order.
    at
        When the set was complete, in seconds.
    transfer
        The name of its transfer.
    """

    __slots__ = ("_groups", "_numbered", "at", "transfer")

    GROUPS: ClassVar[str] = "groups"
    """What the groups are called."""

    def __init__(
        self, groups: Mapping[int, Sequence[Reading]], at: float, transfer: str = ""
    ) -> None:
        self._groups = {group: tuple(values) for group, values in groups.items()}
        self._numbered: dict[int, Mapping[int, Reading]] = {}  # those that were asked for
        self.at = at
        self.transfer = transfer

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


class ReadingRules(Rules):
    """Puts readings by group together; the package says what it guarantees.

    Parameters
    ----------
    parts
        The transfer.
    window
        Seconds that a reading in a result may be old; None: as the spec has it.
    """

    def __init__(self, parts: Parts, window: float | None = None) -> None:
        transfer = parts.transfer
        self._given = window
        self._window = parts.seconds(WINDOW) if window is None else window
        if self._window <= 0:
            raise ValueError(f"{transfer.name}: readings cannot be within {self._window:g} s")
        self._parts = parts
        self._totals = parts.totals
        signals = tuple(part for part in (parts.groups, parts.count) if part)
        numbers = [part for part in (parts.group, parts.number) if part]
        own = (*numbers, *(() if self._totals else signals), *parts.items)
        self.wanted = {parts.messages[0].name: own}
        if self._totals:
            self.wanted[self._totals] = signals
        self._are_totals_own = bool(signals) and not self._totals
        self._items = len(own) - len(parts.items)
        self._before = transfer.first_group - 1, transfer.first_number - 1
        self._fills = fills_of(parts)
        self._cycle: Cycle[tuple[Any, ...]] | None = None
        self._known: Totals | None = None
        self._lacked = ""
        if not signals:
            self._set_totals((), 0.0)

    @property
    def duplicates(self) -> int:
        """Frames that came again before the set was complete."""
        return self._cycle.duplicates if self._cycle else 0

    @property
    def deadline(self) -> float:
        """When `expire` has something to do if no frame arrives; `math.inf` for never."""
        return self._cycle.deadline if self._cycle else math.inf

    def reset(self) -> None:
        """Forget all readings; the totals stay."""
        if self._cycle:
            self._cycle.reset()

    def missing(self) -> str:
        """What still lacks for a result."""
        cycle = self._cycle
        if cycle is None:
            teller = self._totals or self._parts.messages[0].name
            return self._lacked or f"{teller} with the totals is missing"
        if cycle.counts is None or cycle.is_waiting_for_rounds:
            count = self._known.count if self._known else 0
            return f"only {cycle.shape.seen} of {count} readings had a value yet"
        return _named(self._parts, cycle.lacking)

    def feed(
        self, message: str, values: tuple[Any, ...], at: float
    ) -> tuple[Readings | Problem, ...]:
        """What a frame brings about: a result, problems, or neither.

        Takes the totals too, where signals have them: without them nothing is complete.
        """
        cycle = self._cycle
        if (
            cycle is not None
            and at < cycle.deadline
            and message != self._totals
            and not self._are_totals_own
        ):
            return self._feed_frame(cycle, values, at)  # as nearly always
        overdue = self.expire(at)
        if message == self._totals:
            return overdue + self._set_totals(values, at)
        if self._are_totals_own:
            overdue += self._set_totals(values[2 : self._items], at)
        if self._cycle is None:
            return overdue
        return overdue + self._feed_frame(self._cycle, values, at)

    def expire(self, now: float) -> tuple[Problem, ...]:
        """What is overdue at that time; said once until the next result."""
        if self._cycle is None or not self._cycle.expire(now):
            return ()
        text = f"not complete within {self._window:g} s: {self.missing()}"
        return (self._problem("timeout", text, now),)

    def _set_totals(self, values: Sequence[Any], at: float) -> tuple[Problem, ...]:
        """Take the totals: those that are fixed, and what signals say of the others."""
        totals = totals_of(self._parts, [whole(value) for value in values])
        if totals == self._known:
            return ()
        self._known, self._cycle, self._lacked = totals, None, ""
        if totals is None:
            return ()
        shape = shape_of(self._parts, totals)
        if isinstance(shape, str):
            self._lacked = shape
            return (self._problem("totals", shape, at),)
        if self._given is None:
            self._window = self._parts.seconds(WINDOW, frames_of(self._parts, totals))
        self._cycle = Cycle(self._parts.width, self._window, shape)
        return ()

    def _feed_frame(
        self, cycle: Cycle[tuple[Any, ...]], values: tuple[Any, ...], at: float
    ) -> tuple[Readings | Problem, ...]:
        if at - cycle.last > cycle.silence:
            cycle.reset()
        items = values[self._items :]
        key = self._key(values[0], values[1])
        within = len(items)
        if self._fills or not isinstance(items[-1], float):
            within = _last_reading(items, self._fills)
        outcome = cycle.feed(key, within, items, at)
        if outcome is KEPT:
            return ()
        if outcome is Outcome.COMPLETE:
            return (self._result(cycle, at),)
        if outcome is Outcome.FOREIGN:
            return (self._foreign(values[0], values[1], at),)
        return (self._contradiction(cycle, at),)

    def _key(self, group: Any, number: Any) -> int:
        """The key of a frame with this group and number, 0 where there can be none."""
        if type(group) is not int or type(number) is not int:
            group, number = whole(group), whole(number)
            if group is None or number is None:
                return 0
        groups, numbers = self._before
        return key_of(group - groups, number - numbers)

    def _result(self, cycle: Cycle[tuple[Any, ...]], at: float) -> Readings:
        frames = iter(cycle.completed)
        first, width = self._parts.transfer.first_group, cycle.width
        groups: dict[int, list[Reading]] = {}
        for group, count in sorted((cycle.counts or {}).items()):
            pieces = [next(frames) for _ in range(-(count // -width))]
            groups[group - 1 + first] = [each for piece in pieces for each in piece][:count]
        return Readings(groups, at, self._parts.transfer.name)

    def _foreign(self, group: Any, number: Any, at: float) -> Problem:
        word, first = self._parts.word, self._parts.transfer.first_group
        last = first - 1 + (self._known.groups if self._known else 0)
        text = f"frame {number} of {word} {group}; there are {word}s {first} to {last}"
        return self._problem("number", text, at)

    def _contradiction(self, cycle: Cycle[tuple[Any, ...]], at: float) -> Problem:
        count = self._known.count if self._known else 0
        text = f"more readings have come than the {count} that there are"
        if cycle.surplus > count:
            text = f"{cycle.surplus} readings have come, {self._totals} counts {count}"
        return self._problem("totals", text, at)

    def _problem(self, kind: ProblemKind, text: str, at: float) -> Problem:
        return Problem(self._parts.transfer.name, kind, text, at)


def fills_of(parts: Parts) -> tuple[tuple[float, float], ...]:
    """For each item the lowest and highest value that stands for its fill; none without one."""
    fill = parts.transfer.fill
    if fill is None:
        return ()
    steps = [(float(part.signal.factor), float(part.signal.offset)) for part in parts.items]
    middles = [(fill * factor + offset, abs(factor) / 2) for factor, offset in steps]
    return tuple((middle - half, middle + half) for middle, half in middles)


def _last_reading(items: Sequence[Any], fills: Sequence[tuple[float, float]]) -> int:
    """The last reading of a frame that has a value, counted from 1; 0 where none has."""
    for position in range(len(items), 0, -1):
        item = items[position - 1]
        if item is SignalState.INVALID or item is None:
            continue
        if fills and isinstance(item, int | float):
            low, high = fills[position - 1]
            if low < item < high:
                continue
        return position
    return 0


def _named(parts: Parts, keys: Sequence[int]) -> str:
    """Frames that are missing, for people."""
    group, number = parts.transfer.first_group - 1, parts.transfer.first_number - 1
    named = ", ".join(
        f"frame {(key & NUMBERS) + number} of {parts.word} {(key >> NUMBER_BITS) + group}"
        for key in keys[:_NAMED]
    )
    more = f" and {len(keys) - _NAMED} more" if len(keys) > _NAMED else ""
    return f"{named}{more} {'is' if len(keys) == 1 else 'are'} missing"
