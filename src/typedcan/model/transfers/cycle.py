"""When a cycle of readings by group begins, is complete, and is broken."""

from __future__ import annotations

import math
from collections.abc import Mapping
from enum import Enum, auto
from typing import Generic, TypeVar

from typedcan.model.transfers.shape import Shape

PieceT = TypeVar("PieceT")

WINDOW = 1.5
"""Periods that a reading in a cycle may be old, where the spec says nothing."""

SILENCE = 20
"""Windows without a frame after which it may be another sender."""

ROUNDS_IN_DOUBT = 5
"""How often all frames must have come before last readings that never had a value count as such."""

NUMBER_BITS = 16
"""Of a key, which is a frame: its group above these bits, and in them its number as sent."""

NUMBERS = (1 << NUMBER_BITS) - 1
"""The bits of a key that are the number; no frame has a higher one."""

MOST_FRAMES = 1 << 16
"""More different frames of a cycle are never kept."""


class Outcome(Enum):
    """What a frame brings about."""

    KEPT = auto()
    """It is part of the cycle, or nothing but fill."""

    FOREIGN = auto()
    """Its group or number is none that there is."""

    CONTRADICTED = auto()
    """More has come than there is: all is begun anew."""

    COMPLETE = auto()
    """The cycle is complete: `Cycle.completed` has its pieces."""


KEPT = Outcome.KEPT
"""What nearly every frame brings about; looking it up in its class takes longer."""


class Cycle(Generic[PieceT]):
    """Puts cycles together of pieces, whatever those are.

    Parameters
    ----------
    width
        Readings in a frame.
    window
        Seconds that a reading in a cycle may be old.
    shape
        How many readings each group has.
    """

    def __init__(self, width: int, window: float, shape: Shape) -> None:
        self.width = width
        self.window = window
        self.silence = SILENCE * window
        """Seconds without a frame after which, with the next one, all is to be begun anew."""
        self.shape = shape
        self.duplicates = 0
        """Frames that came again before the cycle was complete."""
        self.surplus = 0
        """How many readings had come where more came than there are."""
        self.version = 0
        """Changes with what is known of the shape."""
        self.reset()

    def reset(self) -> None:
        """Begin anew; what the totals say of the shape stays."""
        self.pieces: dict[int, PieceT] = {}
        """What the cycle is made of so far, by key."""
        self.completed: list[PieceT] = []
        self.last = math.inf
        """When a frame came last."""
        self.deadline = math.inf
        """When `expire` has something to say if no frame arrives; `math.inf` for never."""
        self.wanted: tuple[int, ...] = ()
        """The keys of a cycle, ascending; none while they are not known."""
        self.counts: Mapping[int, int] | None = None
        """The readings of each group, while they are known."""
        self.shape = self.shape.anew()
        self.version += 1
        self._at: dict[int, float] = {}
        self._known: dict[int, int] = {}  # frames that say nothing new: up to which reading
        self._lacking: set[int] = set()
        self._rounds = 0
        self._overdue = False
        self._reshape()

    @property
    def is_at_begin(self) -> bool:
        """Whether nothing of a cycle has come, and one that comes would count."""
        return not self.pieces and bool(self.wanted) and self.is_believed

    @property
    def is_believed(self) -> bool:
        """Whether a cycle counts: last readings without a value can be fill, with more to come."""
        return self.shape.is_certain or self._rounds >= ROUNDS_IN_DOUBT

    @property
    def lacking(self) -> list[int]:
        """The keys that have yet to come; all where it waits for the next cycle."""
        return sorted(self._lacking)

    @property
    def is_waiting_for_rounds(self) -> bool:
        """Whether all frames came, but not often enough to be believed."""
        return self._rounds > 0 and not self.shape.is_certain

    def expire(self, now: float) -> bool:
        """Whether a cycle is overdue at that time; True once until the next that is complete."""
        if now < self.deadline:
            return False
        self.deadline = math.inf
        self._overdue = True
        return True

    def feed(self, key: int, within: int, piece: PieceT, at: float) -> Outcome:
        """Feed a frame, after `expire`, and `reset` where `silence` has passed since the `last`.

        Parameters
        ----------
        key
            Of the frame, see `key_of`.
        within
            The last of its readings that has a value, from 1; 0 where none has.
        """
        self.last = at
        if within > self._known.get(key, -1):
            outcome = self._learn(key, within)
            if outcome is not Outcome.COMPLETE:
                return outcome
        if key in self.pieces:
            self.duplicates += 1
        elif len(self.pieces) >= MOST_FRAMES:
            return Outcome.FOREIGN
        if self.deadline == math.inf and not self._overdue:
            self.deadline = at + self.window
        self.pieces[key] = piece
        self._at[key] = at
        self._lacking.discard(key)
        if self._lacking or not self.counts or not self._is_complete(at):
            return KEPT
        return Outcome.COMPLETE

    def _learn(self, key: int, within: int) -> Outcome:
        """What a frame says of the shape; COMPLETE: it is one to keep."""
        group, number = key >> NUMBER_BITS, key & NUMBERS
        shape = self.shape
        before = (number - 1 - shape.before(group)) * self.width
        if number < 1 or not shape.has(group) or before < 0:
            return Outcome.FOREIGN
        highest = before + within
        if before >= shape.limit(group):
            if not within:
                return Outcome.KEPT
            if shape.is_fixed:
                return Outcome.FOREIGN
        if within and highest > shape.known(group) and shape.see(group, highest):
            if shape.is_contradicted:
                self.surplus = shape.seen
                self.reset()
                return Outcome.CONTRADICTED
            self.version += 1
            self._reshape()
        if not within or highest <= shape.known(group):
            self._known[key] = within
        return Outcome.COMPLETE

    def _reshape(self) -> None:
        """Take over what is known of the shape."""
        counts = self.shape.counts()
        if counts != self.counts:
            self.counts = counts
            self._rounds = 0
            self.wanted = tuple(
                group << NUMBER_BITS | self.shape.before(group) + number
                for group, count in sorted((counts or {}).items())
                for number in frames_in(count, self.width)
            )
            self._lacking = set(self.wanted).difference(self.pieces)

    def _is_complete(self, at: float) -> bool:
        """Whether a cycle that lacks nothing counts."""
        stale = {key for key in self.wanted if at - self._at[key] > self.window}
        if stale:
            self._lacking = stale
            return False
        self._rounds += 1
        self.deadline = math.inf
        self._lacking = set(self.wanted)
        if not self.is_believed:
            return False
        self.completed = [self.pieces[key] for key in self.wanted]
        self.pieces.clear()
        self._at.clear()
        self._overdue = False
        return True


def key_of(group: int, number: int) -> int:
    """The key of a frame by its group and number, both from 1; 0, which is none, for others."""
    return group << NUMBER_BITS | number if group > 0 and 0 < number <= NUMBERS else 0


def frames_in(count: int, width: int) -> range:
    """The frame numbers of a group with so many readings, ``width`` in a frame."""
    return range(1, math.ceil(count / width) + 1)
