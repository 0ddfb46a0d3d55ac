"""Which frames make complete cycles: frame by frame where they are irregular, else in leaps."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.transfers.readings import ReadingFrames
from typedcan.model.transfers.cycle import NUMBER_BITS, NUMBERS, Cycle, Outcome
from typedcan.model.transfers.kind import ProblemKind
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

    def problems(self) -> Counter[ProblemKind]:
        """The same as live nodes tell of it."""
        return +Counter[ProblemKind](
            {"timeout": self.incomplete, "number": self.foreign, "totals": self.contradictions}
        )


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

    def begin(self, shape: Shape, at: float, window: float) -> None:
        """Begin anew with another shape and window, at that time."""
        self.expire(at)
        self._window = window
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
        cycle, feed = self._cycle, self._cycle.feed
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
            outcome = feed(key, within, row, at)
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


class Regular:
    """Finds whole cycles that can be taken without a look at their frames one by one.

    Parameters
    ----------
    frames
        The frames.
    first, stop
        Which of them count.
    cycle
        What a cycle has, and what of it is nothing new.
    """

    def __init__(self, frames: ReadingFrames, first: int, stop: int, cycle: Cycle[int]) -> None:
        self._wanted = np.array(cycle.wanted, np.int64)
        self._time = frames.time
        self._key = frames.key
        self._stop = stop
        length = len(self._wanted)
        own = slice(first, stop)
        key = frames.key[own]
        # The highest frame of each group, and the readings there, that say nothing new.
        groups = range(max(cycle.counts or (), default=0) + 1)
        group = np.minimum(key >> NUMBER_BITS, groups[-1])  # others end a stretch anyway
        known = np.array([cycle.shape.known(each) for each in groups], np.int64)
        before = np.array([cycle.shape.before(each) for each in groups], np.int64)
        within = frames.within[own]
        highest = ((key & NUMBERS) - 1 - before[group]) * cycle.width + within
        news = (highest > known[group]) & (within > 0)
        self._news = np.flatnonzero(news) + first
        self._breaks = np.flatnonzero(key[length:] != key[:-length]) + first + length
        self._steps = np.diff(frames.time[own], prepend=frames.time[first : first + 1])
        self._first = first

    def cycles(self, row: int, last: float, window: float, silence: float) -> NDArray[np.int64]:
        """The rows of the whole cycles from ``row`` on, shape (cycles, frames in a cycle).

        ``last`` is when the frame before came; ``window`` is how long a cycle may take, and
        ``silence`` how long a pause may be, in seconds.
        """
        length = len(self._wanted)
        none = np.empty((0, length), np.int64)
        if row + length > self._stop or self._time[row] - last > silence:
            return none
        own = self._key[row : row + length]
        order = own.argsort(kind="stable")
        if not np.array_equal(own[order], self._wanted):
            return none
        end = self._before(self._news, row, self._before(self._breaks, row + length, self._stop))
        count = self._in_time((end - row) // length, row, window, silence)
        first = np.arange(row, row + count * length, length, dtype=np.int64)
        return first[:, np.newaxis] + order

    @staticmethod
    def _before(places: NDArray[np.int64], row: int, stop: int) -> int:
        """The first of the places from ``row`` on, at most ``stop``."""
        at = int(np.searchsorted(places, row))
        return min(int(places[at]), stop) if at < len(places) else stop

    def _in_time(self, count: int, row: int, window: float, silence: float) -> int:
        """How many of the cycles come before one that takes too long, or a pause."""
        length = len(self._wanted)
        shape = (count, length)
        end = row + count * length
        times = self._time[row:end].reshape(shape)
        steps = self._steps[row - self._first : end - self._first].reshape(shape)
        begins, ends = times[:, 0], times[:, -1]
        good = (ends < begins + window) & (ends - begins <= window)
        good &= (steps[:, 1:] >= 0).all(axis=1)
        good[1:] &= (steps[1:, 0] >= 0) & (steps[1:, 0] <= silence)
        return count if good.all() else int(good.argmin())
