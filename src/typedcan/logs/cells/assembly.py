"""Which frames make complete cycles: frame by frame where they are irregular, else in leaps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.cells.readings import ReadingFrames
from typedcan.logs.cells.regular import Regular
from typedcan.model.transfers.cycle import Cycle, Outcome
from typedcan.model.transfers.shape import Shape

_CHUNK = 256
"""Frames looked at one by one before a leap is tried again."""


@dataclass(slots=True)
class CycleCounts:
    """What became of the frames.

    Parameters
    ----------
    complete
        Cycles that have a row.
    incomplete
        How often a cycle was not complete in time; until the next one that is complete, this counts
        once.
    foreign
        Frames with a group or number that there is not.
    contradictions
        How often more readings came than there are, after which all was begun anew.
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
        The number of readings of each group.
    rows
        Of the frames, shape (cycles, frames in a cycle), in the order of the readings.
    """

    counts: tuple[tuple[int, int], ...]
    rows: NDArray[np.int64]


class Assembly:
    """Finds complete cycles, with the rules of live nodes.

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
        self.counts = CycleCounts()
        self.forgotten = False
        """Whether the shape has to be found out anew; frames are no longer taken then."""
        self._width = width
        self._window = window
        self._cycle = Cycle[int](width, window, shape)

    @property
    def pieces(self) -> dict[int, int]:
        """The rows that the next cycle is made of so far, by key."""
        return self._cycle.pieces

    def begin(self, shape: Shape, at: float) -> None:
        """Begin anew with another shape, at that time."""
        self.expire(at)
        self._cycle = Cycle(self._width, self._window, shape)
        self.forgotten = False

    def forget(self, at: float) -> None:
        """Take no more frames until it is known what a cycle has."""
        self.expire(at)
        self._cycle.reset()
        self.forgotten = True

    def expire(self, now: float) -> None:
        """Count the cycle that is incomplete for too long at that time."""
        self.counts.incomplete += self._cycle.expire(now)

    def run(self, frames: ReadingFrames, row: int, stop: int) -> tuple[int, list[Complete]]:
        """Take the frames from ``row`` on, and stop early where `forgotten` is.

        What `pieces` holds has to be rows of ``frames``. Gives the row to go on with, and what is
        complete.
        """
        found: list[Complete] = []
        regular: Regular | None = None
        cycle, version = self._cycle, self._cycle.version
        while row < stop and not self.forgotten:
            if cycle.is_at_begin:
                if regular is None or version != cycle.version:
                    version = cycle.version
                    regular = Regular(frames, row, stop, cycle)
                rows = regular.cycles(row, cycle.last, cycle.window, cycle.silence)
                if len(rows):
                    found.append(self._complete(rows))
                    row += rows.size
                    cycle.last = float(frames.time[row - 1])
                    continue
            row = self._step_by_step(frames, row, min(row + _CHUNK, stop), found)
        return row, found

    def _step_by_step(
        self, frames: ReadingFrames, row: int, stop: int, found: list[Complete]
    ) -> int:
        """Up to the first complete cycle; gives the row behind."""
        cycle, take = self._cycle, self._cycle.take
        part = slice(row, stop)
        times, keys = frames.time[part].tolist(), frames.key[part].tolist()
        for at, key, within in zip(times, keys, frames.within[part].tolist(), strict=True):
            if at >= cycle.deadline:
                self.expire(at)
            if at - cycle.last > cycle.silence:
                cycle.reset()
                if cycle.shape.forgettable:
                    self.forgotten = True
                    return row
            outcome = take(key, within, row, at)
            row += 1
            if outcome is Outcome.KEPT:
                continue
            if outcome is Outcome.COMPLETE:
                found.append(self._complete(np.array([cycle.completed], np.int64)))
                break
            if outcome is Outcome.FOREIGN:
                self.counts.foreign += 1
            elif outcome is Outcome.CONTRADICTED:
                self.counts.contradictions += 1
                if cycle.shape.forgettable:
                    self.forgotten = True
                    break
        return row

    def _complete(self, rows: NDArray[np.int64]) -> Complete:
        self.counts.complete += len(rows)
        return Complete(tuple(sorted((self._cycle.counts or {}).items())), rows)
