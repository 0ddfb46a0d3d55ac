"""Stretches in which cycle after cycle has the same frames in the same order."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.cells.readings import ReadingFrames
from typedcan.model.transfers.cycle import NUMBER_BITS, NUMBERS, Cycle


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
        odd = (highest > known[group]) & (within > 0)
        self._odd = np.flatnonzero(odd) + first
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
        end = self._before(self._odd, row, self._before(self._breaks, row + length, self._stop))
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
