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
        self.shape = shape
        self.duplicates = 0
        """Frames that came again before the cycle was complete."""
        self.surplus = 0
        """How many readings had come where more came than there are."""
        self.version = 0
        """Changes with what is known of the shape."""
        self.reset()

    def reset(self) -> None:
        """Begin anew; what was told of the shape stays."""
        self.pieces: dict[int, PieceT] = {}
        """What the cycle is made of so far, by key."""
        self.completed: list[PieceT] = []
        self.last = math.inf
        """When a frame came last."""
        self.wanted: tuple[int, ...] = ()
        """The keys of a cycle, ascending; none while they are not known."""
        self.counts: Mapping[int, int] | None = None
        """The readings of each group, while they are known."""
        self.shape = self.shape.anew()
        self.version += 1
        self._at: dict[int, float] = {}
        self._fresh: set[int] = set()  # came since the last complete cycle
        self._lacking: set[int] = set()
        self._rounds = 0
        self._since = math.inf  # the first frame of a cycle that is not overdue yet
        self._overdue = False
        self._reshape()

    @property
    def deadline(self) -> float:
        """When `expire` has something to say if no frame arrives; `math.inf` for never."""
        return self._since + self.window

    @property
    def is_at_begin(self) -> bool:
        """Whether nothing of a cycle has come, and one that comes would count."""
        return not self._fresh and bool(self.wanted) and self.is_believed

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
        if now < self._since + self.window:
            return False
        self._since = math.inf
        self._overdue = True
        return True

    def is_silent(self, at: float) -> bool:
        """Whether before a frame at that time nothing came for so long that all is forgotten."""
        return at - self.last > SILENCE * self.window

    def take(self, group: int, number: int, within: int, piece: PieceT, at: float) -> Outcome:
        """Take a frame, after `expire` and what follows from `is_silent`.

        Parameters
        ----------
        group, number
            Of the frame, both from 1.
        within
            The last of its readings that has a value, from 1; 0 where none has.
        """
        self.last = at
        shape = self.shape
        if number < 1 or not shape.has(group):
            return Outcome.FOREIGN
        before = (number - 1 - shape.before(group)) * self.width
        if before < 0:
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
        return self._keep(group << NUMBER_BITS | number, piece, at)

    def _keep(self, key: int, piece: PieceT, at: float) -> Outcome:
        if key not in self.pieces and len(self.pieces) >= MOST_FRAMES:
            return Outcome.FOREIGN
        if self._since == math.inf and not self._overdue:
            self._since = at
        self.duplicates += key in self._fresh
        self.pieces[key] = piece
        self._at[key] = at
        self._fresh.add(key)
        self._lacking.discard(key)
        if not self.counts or self._lacking:
            return Outcome.KEPT
        return Outcome.COMPLETE if self._is_complete(at) else Outcome.KEPT

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
            self._lacking = set(self.wanted) - self._fresh

    def _is_complete(self, at: float) -> bool:
        """Whether a cycle that lacks nothing counts."""
        stale = {key for key in self.wanted if at - self._at[key] > self.window}
        if stale:
            self._lacking = stale
            return False
        self._rounds += 1
        self._since = math.inf
        self._lacking = set(self.wanted)
        if not self.is_believed:
            return False
        self.completed = [self.pieces[key] for key in self.wanted]
        self.pieces.clear()
        self._at.clear()
        self._fresh.clear()
        self._overdue = False
        return True


def frames_in(count: int, width: int) -> range:
    """The frame numbers of a group with so many readings, ``width`` in a frame."""
    return range(1, math.ceil(count / width) + 1)
