"""Stretches in which cycle after cycle has the same frames in the same order."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.cells.readings import ReadingFrames
from typedcan.logs.grouped import KEY_BITS

_CSCS = 1 << 8


class Regular:
    """Finds whole cycles that can be taken without a look at their frames one by one.

    Parameters
    ----------
    frames
        The frames.
    first, stop
        Which of them count.
    wanted
        The keys of a cycle, ascending.
    known
        The highest reading of a CSC that is nothing new.
    """

    def __init__(
        self,
        frames: ReadingFrames,
        first: int,
        stop: int,
        wanted: tuple[int, ...],
        known: Callable[[int], int],
    ) -> None:
        self.wanted = wanted
        self._keys = np.array(wanted, np.int32)
        self._time = frames.time
        self._key = frames.key
        self._stop = stop
        length = len(wanted)
        own = slice(first, stop)
        key = frames.key[own]
        limits = np.array([known(csc) for csc in range(_CSCS)], np.int32)
        odd = frames.highest[own] > limits[key >> KEY_BITS]
        self._odd = np.flatnonzero(odd) + first
        self._breaks = np.flatnonzero(key[length:] != key[:-length]) + first + length
        self._steps = np.diff(frames.time[own], prepend=frames.time[first : first + 1])
        self._first = first

    def cycles(self, row: int, last: float, window: float, silence: float) -> NDArray[np.int64]:
        """The rows of the whole cycles from ``row`` on, shape (cycles, frames in a cycle).

        ``last`` is when the frame before came; ``window`` is how long a cycle may take, and
        ``silence`` how long a pause may be, in seconds.
        """
        length = len(self.wanted)
        none = np.empty((0, length), np.int64)
        if row + length > self._stop or self._time[row] - last > silence:
            return none
        own = self._key[row : row + length]
        order = own.argsort(kind="stable")
        if not np.array_equal(own[order], self._keys):
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
        length = len(self.wanted)
        shape = (count, length)
        end = row + count * length
        times = self._time[row:end].reshape(shape)
        steps = self._steps[row - self._first : end - self._first].reshape(shape)
        begins, ends = times[:, 0], times[:, -1]
        good = (ends < begins + window) & (ends - begins <= window)
        good &= (steps[:, 1:] >= 0).all(axis=1)
        good[1:] &= (steps[1:, 0] >= 0) & (steps[1:, 0] <= silence)
        return count if good.all() else int(good.argmin())
