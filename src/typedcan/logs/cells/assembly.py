"""Which frames make complete cycles: frame by frame where they are irregular, else in leaps."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.cells.readings import ReadingFrames
from typedcan.logs.cells.regular import Regular
from typedcan.logs.grouped import KEY_BITS
from typedcan.model.transfers.cycle import frames_in
from typedcan.model.transfers.shape import Shape

_WINDOW_PERIODS = 1.5
"""Periods that a reading in a cycle may be old."""

_ROUNDS_IN_DOUBT = 5
"""How often all frames must have come before last readings that never had a value count as such."""

_SILENCE = 20
"""Windows without a frame after which it may be another pack."""

_CHUNK = 256
"""Frames looked at one by one before a leap is tried again."""

_NUMBER = (1 << KEY_BITS) - 1


@dataclass(slots=True)
class CycleCounts:
    """What became of the frames.

    Parameters
    ----------
    complete
        Cycles that have a row.
    incomplete
        How often a cycle was not complete within one and a half periods; until the next one that
        is complete, this counts once.
    foreign
        Frames with a CSC or number that the pack has not.
    contradictions
        How often more readings came than the pack has, after which all was begun anew.
    unassigned
        Frames that came before it was known what a cycle has.
    """

    complete: int = 0
    incomplete: int = 0
    foreign: int = 0
    contradictions: int = 0
    unassigned: int = 0

    def add(self, other: CycleCounts) -> None:
        """Add the counts of another channel."""
        self.complete += other.complete
        self.incomplete += other.incomplete
        self.foreign += other.foreign
        self.contradictions += other.contradictions
        self.unassigned += other.unassigned


@dataclass(frozen=True, slots=True)
class Complete:
    """Complete cycles of one layout.

    Parameters
    ----------
    counts
        The number of readings of each CSC.
    rows
        Of the frames, shape (cycles, frames in a cycle), in the order of the readings.
    """

    counts: tuple[tuple[int, int], ...]
    rows: NDArray[np.int64]


class Assembly:
    """Finds complete cycles, with the rules of `swapcan.transfer`.

    Parameters
    ----------
    width
        Readings in a frame.
    period
        Seconds between cycles.
    shape
        How many readings each CSC has.
    """

    def __init__(self, width: int, period: float, shape: Shape) -> None:
        self.counts = CycleCounts()
        self.pieces: dict[int, int] = {}
        """The rows that the next cycle is made of so far, by key."""
        self.forgotten = False
        """Whether the shape has to be found out anew; frames are no longer taken then."""
        self._width = width
        self._window = _WINDOW_PERIODS * period
        self._shape = shape
        self._since = math.inf  # the first frame of a cycle that is not overdue yet
        self._last = math.inf
        self._version = 0  # of what the shape says is known
        self._reset()

    def begin(self, shape: Shape, at: float) -> None:
        """Begin anew with another shape, at that time."""
        self.expire(at)
        self._shape = shape
        self.forgotten = False
        self._reset()

    def forget(self, at: float) -> None:
        """Take no more frames until it is known what a cycle has."""
        self.expire(at)
        self._reset()
        self.forgotten = True

    def expire(self, now: float) -> None:
        """Count the cycle that is incomplete for too long at that time."""
        if now >= self._since + self._window:
            self._since = math.inf
            self._overdue = True
            self.counts.incomplete += 1

    def run(self, frames: ReadingFrames, row: int, stop: int) -> tuple[int, list[Complete]]:
        """Take the frames from ``row`` on, and stop early where `forgotten` is.

        What `pieces` holds has to be rows of ``frames``. Gives the row to go on with, and what is
        complete.
        """
        found: list[Complete] = []
        regular: Regular | None = None
        version = self._version
        while row < stop and not self.forgotten:
            if self._at_begin():
                if regular is None or version != self._version:
                    version = self._version
                    regular = Regular(frames, row, stop, self._wanted, self._shape.known)
                rows = regular.cycles(row, self._last, self._window, _SILENCE * self._window)
                if len(rows):
                    found.append(Complete(self._layout, rows))
                    self.counts.complete += len(rows)
                    row += rows.size
                    self._last = float(frames.time[row - 1])
                    continue
            row = self._step_by_step(frames, row, min(row + _CHUNK, stop), found)
        return row, found

    def _reset(self) -> None:
        self.pieces.clear()
        self._shape = self._shape.anew()
        self._version += 1
        self._fresh: set[int] = set()  # came since the last complete cycle
        self._wanted: tuple[int, ...] = ()
        self._lacking: set[int] = set()
        self._layout: tuple[tuple[int, int], ...] = ()
        self._known: Mapping[int, int] | None = None
        self._rounds = 0
        self._since = math.inf
        self._last = math.inf
        self._overdue = False
        self._reshape()

    def _at_begin(self) -> bool:
        return not self._fresh and bool(self._wanted) and self._counts()

    def _step_by_step(
        self, frames: ReadingFrames, row: int, stop: int, found: list[Complete]
    ) -> int:
        """Up to the first complete cycle; gives the row behind."""
        part = slice(row, stop)
        times, keys = frames.time[part].tolist(), frames.key[part].tolist()
        for at, key, highest in zip(times, keys, frames.highest[part].tolist(), strict=True):
            self.expire(at)
            if at - self._last > _SILENCE * self._window:
                self._reset()
                if self._shape.forgettable:
                    self.forgotten = True
                    return row
            self._last = at
            row += 1
            if self._keep(key, highest, row - 1, at) and self._is_complete(frames, at):
                rows = np.array([[self.pieces[key] for key in self._wanted]], np.int64)
                found.append(Complete(self._layout, rows))
                self.counts.complete += 1
                self._fresh.clear()
                self.pieces.clear()
                self._overdue = False
                break
            if self.forgotten:
                break
        return row

    def _keep(self, key: int, highest: int, row: int, at: float) -> bool:
        """Take a frame; whether none is lacking now."""
        shape, csc, number = self._shape, key >> KEY_BITS, key & _NUMBER
        if number < 1 or not shape.has(csc):
            self.counts.foreign += 1
            return False
        if not highest and (number - 1) * self._width >= shape.limit(csc):
            return False  # nothing but fill
        if highest > shape.known(csc) and shape.see(csc, highest):
            if shape.is_contradicted:
                self.counts.contradictions += 1
                self._reset()
                self.forgotten = shape.forgettable
                return False
            self._version += 1
            self._reshape()
        if self._since == math.inf and not self._overdue:
            self._since = at
        self.pieces[key] = row
        self._fresh.add(key)
        self._lacking.discard(key)
        return bool(self._known) and not self._lacking

    def _reshape(self) -> None:
        """Take over what is known of the shape."""
        known = self._shape.counts()
        if known != self._known:
            self._known = known
            self._rounds = 0
            self._layout = tuple(sorted((known or {}).items()))
            self._wanted = tuple(
                csc << KEY_BITS | number
                for csc, count in self._layout
                for number in frames_in(count, self._width)
            )
            self._lacking = set(self._wanted) - self._fresh

    def _is_complete(self, frames: ReadingFrames, at: float) -> bool:
        """Whether a cycle that lacks nothing counts."""
        oldest = frames.time[[self.pieces[key] for key in self._wanted]]
        stale = at - oldest > self._window
        if stale.any():
            self._lacking = {self._wanted[place] for place in np.flatnonzero(stale)}
            return False
        self._rounds += 1
        self._since = math.inf
        self._lacking = set(self._wanted)
        return self._counts()

    def _counts(self) -> bool:
        """Whether a cycle counts: last readings without a value can be fill, with more to come."""
        return self._shape.is_certain or self._rounds >= _ROUNDS_IN_DOUBT
