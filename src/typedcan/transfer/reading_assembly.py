"""Readings by group put together, and told complete from incomplete."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from operator import attrgetter
from typing import Any, Generic, TypeVar

from typedcan.transfer.layout import group_word
from typedcan.transfer.problem import Kind, Problem
from typedcan.transfer.readings import Reading, Readings
from typedcan.transfer.shape import Shape, Totals
from typedcan.wire.message import Message, SignalState
from typedcan.wire.protocol import FieldRef, Transfer

ReadingsT = TypeVar("ReadingsT", bound=Readings)

_WINDOW_PERIODS = 1.5
_ROUNDS_IN_DOUBT = 5
"""How often all frames must have come before last readings that never had a value count as such."""

_SILENCE = 20
"""Windows without a frame after which it may be another sender."""

_NAMED = 3
"""How many missing frames are named one by one."""


_Key = tuple[int, int]
"""A frame: its group, and its number there."""

_Piece = tuple[Message, float]
"""A message, and when it came; it is taken to pieces once all are there."""


class ReadingsAssembler(Generic[ReadingsT]):
    """What readings by group have in common; the package's docstring says what it guarantees.

    Parameters
    ----------
    transfer
        What the protocol says of it.
    make
        Makes the result from the readings of each group and the time.
    window
        Seconds that a reading in a result may be old; by default one and a half periods.
    """

    def __init__(
        self,
        transfer: Transfer,
        make: Callable[[Mapping[int, Sequence[Reading]], float], ReadingsT],
        window: float | None,
    ) -> None:
        self.duplicates = 0
        """Frames that came again before the set was complete."""
        self._transfer = transfer
        self._make = make
        self._message = transfer.messages[0]
        self._window = _WINDOW_PERIODS * (self._message.PERIOD or 0) if window is None else window
        if self._window <= 0:
            raise ValueError(f"{transfer.name}: readings cannot be within {self._window:g} s")
        self._width = len(transfer.items)
        self._readings: Callable[[Message], tuple[Reading, ...]] = attrgetter(
            *(item.field for item in transfer.items)
        )
        self._place: Callable[[Message], tuple[int | SignalState, int]] = attrgetter(
            _ref(transfer.group).field, _ref(transfer.frame_number).field
        )
        self._totals = _ref(transfer.count_field).message
        self._word = group_word(transfer)
        self._shape: Shape | None = None
        self.reset()

    def reset(self) -> None:
        """Forget all readings; the totals stay."""
        self._pieces: dict[_Key, _Piece] = {}
        self._fresh: set[_Key] = set()  # came since the last result
        self._wanted: frozenset[_Key] = frozenset()  # what a result takes
        self._lacking: set[_Key] = set()  # has yet to come for the next one
        self._rounds = 0
        self._since = math.inf
        self._last = math.inf
        self._overdue = False
        self._counts: Mapping[int, int] | None = None
        if self._shape:
            self._reshape(Shape(self._shape.totals))

    @property
    def deadline(self) -> float:
        """When `expire` has something to do if no frame arrives; `math.inf` for never."""
        return self._since + self._window

    def missing(self) -> str:
        """What still lacks for a result."""
        if self._shape is None:
            return f"{_ref(self._transfer.count_field).message.NAME} with the totals is missing"
        if self._counts is None or (self._rounds and not self._shape.is_certain):
            return f"only {self._shape.seen} of {self._shape.totals.count} readings had a value yet"
        keys = sorted(self._lacking)
        named = ", ".join(
            f"frame {number} of {self._word} {group}" for group, number in keys[:_NAMED]
        )
        more = f" and {len(keys) - _NAMED} more" if len(keys) > _NAMED else ""
        return f"{named}{more} {'is' if len(keys) == 1 else 'are'} missing"

    def take(self, message: Message, at: float) -> tuple[ReadingsT | Problem, ...]:
        """What a message brings about: a result, problems, or neither.

        Takes the totals too, without which nothing is complete. Messages of other transfers bring
        nothing about. ``at`` is the time in seconds.
        """
        if type(message) is self._message and self._shape:
            overdue = self.expire(at)
            if at - self._last > _SILENCE * self._window:
                self.reset()
            self._last = at
            return overdue + self._take_frame(message, self._shape, at)
        if type(message) is self._totals:
            return self._take_totals(message)
        return ()

    def expire(self, now: float) -> tuple[Problem, ...]:
        """What is overdue at that time; said once until the next result."""
        if now < self._since + self._window:
            return ()
        self._since = math.inf
        self._overdue = True
        text = f"not complete within {self._window:g} s: {self.missing()}"
        return (self._problem("timeout", text, now),)

    def _take_totals(self, message: Message) -> tuple[()]:
        groups = _value(message, _ref(self._transfer.groups_field))
        count = _value(message, _ref(self._transfer.count_field))
        known = self._shape.totals if self._shape else None
        if known is None or known.groups != groups or known.count != count:
            # A sender that counts none has not counted yet.
            self._shape = Shape(Totals(groups, count)) if groups and count else None
            self.reset()
        return ()

    def _take_frame(
        self, message: Message, shape: Shape, at: float
    ) -> tuple[ReadingsT | Problem, ...]:
        group, number = self._place(message)
        if isinstance(group, SignalState) or not 1 <= group <= shape.totals.groups or number < 1:
            there = f"there are {self._word}s 1 to {shape.totals.groups}"
            text = f"frame {number} of {self._word} {group}; {there}"
            return (self._problem("number", text, at),)
        # A frame below the highest reading of its group says nothing new of the shape.
        if shape.highest(group) < number * self._width:
            before = (number - 1) * self._width
            highest = _highest(self._readings(message))
            if not highest and before >= shape.totals.count:
                return ()  # nothing but fill
            if highest and shape.see(group, before + highest):
                if shape.is_contradicted:
                    return (self._contradiction(shape, at),)
                self._reshape(shape)
        self._keep((group, number), message, at)
        return self._complete(shape, at) if self._counts and not self._lacking else ()

    def _keep(self, key: _Key, message: Message, at: float) -> None:
        if self._since == math.inf and not self._overdue:
            self._since = at
        self.duplicates += key in self._fresh
        self._pieces[key] = (message, at)
        self._fresh.add(key)
        self._lacking.discard(key)

    def _reshape(self, shape: Shape) -> None:
        """Take over what is known of the shape."""
        self._shape = shape
        counts = shape.counts()
        if counts != self._counts:
            self._counts = counts
            self._rounds = 0
            self._wanted = frozenset(
                (group, number)
                for group, count in (counts or {}).items()
                for number in self._numbers(count)
            )
            self._lacking = set(self._wanted - self._fresh)

    def _numbers(self, count: int) -> range:
        """The frame numbers of a group with so many readings."""
        return range(1, math.ceil(count / self._width) + 1)

    def _contradiction(self, shape: Shape, at: float) -> Problem:
        name = _ref(self._transfer.count_field).message.NAME
        text = f"{shape.seen} readings have come, {name} counts {shape.totals.count}"
        self.reset()
        return self._problem("totals", text, at)

    def _complete(self, shape: Shape, at: float) -> tuple[ReadingsT, ...]:
        stale = {key for key in self._wanted if at - self._pieces[key][1] > self._window}
        if stale:
            self._lacking = stale
            return ()
        self._rounds += 1
        self._since = math.inf
        self._lacking = set(self._wanted)
        # Last readings without a value look like fill: a group with more may still be to come.
        if not shape.is_certain and self._rounds < _ROUNDS_IN_DOUBT:
            return ()
        self._fresh.clear()
        self._overdue = False
        groups = {
            group: self._of_group(group, count) for group, count in (self._counts or {}).items()
        }
        return (self._make(groups, at),)

    def _of_group(self, group: int, count: int) -> list[Reading]:
        messages = (self._pieces[group, number][0] for number in self._numbers(count))
        return [reading for message in messages for reading in self._readings(message)][:count]

    def _problem(self, kind: Kind, text: str, at: float) -> Problem:
        return Problem(self._transfer.name, kind, text, at)


def _highest(readings: Sequence[Reading]) -> int:
    """The last reading that is not INVALID, counted from 1; 0 where all are."""
    for position in range(len(readings), 0, -1):
        if readings[position - 1] is not SignalState.INVALID:
            return position
    return 0


def _ref(ref: FieldRef | None) -> FieldRef:
    if ref is None:
        raise LookupError("the transfer lacks its frame number, group or totals")
    return ref


def _value(message: Message, ref: FieldRef) -> int:
    value: Any = getattr(message, ref.field)
    return int(value)
