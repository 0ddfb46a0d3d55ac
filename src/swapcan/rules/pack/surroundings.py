"""Frames of one message beside the frames of another around them.

The two are not sent in the same moment, and each may tell what was measured up to one period ago.
So a frame is held against two frames of the other message before it and two after it.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from swapcan.rules.shared import AROUND
from typedcan.judge.series import Series
from typedcan.judge.tolerance import Limits

SIDE = 2
"""Frames on each side."""


class Rows(NamedTuple):
    """Frames: seconds since the log's begin, numbers in the log, and something of each."""

    time: NDArray[np.float64]
    order: NDArray[np.int64]
    data: NDArray[Any]

    def part(self, rows: slice) -> Rows:
        """Some of them, copied."""
        return Rows(self.time[rows].copy(), self.order[rows].copy(), self.data[rows].copy())

    def followed_by(self, other: Rows) -> Rows:
        """These and those."""
        if not len(self.time):
            return other
        return Rows(
            np.concatenate([self.time, other.time]),
            np.concatenate([self.order, other.order]),
            np.concatenate([self.data, other.data]),
        )


def rows_of(series: Series, data: NDArray[Any]) -> Rows:
    """The new rows of a series, and of what was made of all its rows."""
    own = slice(series.first, None)
    return Rows(series.time[own], series.order[own], data[own])


class Surrounded(NamedTuple):
    """n frames and what is around them.

    ``around`` has the data of the others, shape (2 `SIDE`, n); it means nothing where they are not
    ``known``, as some did not come.
    """

    frames: Rows
    around: NDArray[Any]
    known: NDArray[np.bool_]


class Surroundings:
    """Hands out each frame once it is known what is around it."""

    def __init__(self, limits: Limits) -> None:
        self._apart = limits.limit(AROUND)
        self._waiting: Rows | None = None
        self._others: Rows | None = None

    def feed(self, frames: Rows, others: Rows, now: float) -> Surrounded:
        """Those that are ready with new frames of both; ``now`` is the latest time."""
        self._waiting = frames if self._waiting is None else self._waiting.followed_by(frames)
        self._others = others if self._others is None else self._others.followed_by(others)
        behind = np.searchsorted(self._others.order, self._waiting.order)
        ready = behind + SIDE <= len(self._others.order)
        ready |= self._waiting.time + SIDE * self._apart < now
        return self._ready(len(ready) if ready.all() else int(ready.argmin()))

    def finish(self) -> Surrounded | None:
        """What is left; None where nothing came."""
        return None if self._waiting is None else self._ready(len(self._waiting.time))

    def _ready(self, count: int) -> Surrounded:
        """What is around the first frames that wait; they no longer do."""
        assert self._waiting is not None
        assert self._others is not None
        frames, others = self._waiting.part(slice(count)), self._others
        self._waiting = self._waiting.part(slice(count, None))
        self._others = others.part(slice(-2 * SIDE, None))
        if len(others.time) < 2 * SIDE:
            nothing = np.zeros((2 * SIDE, count), others.data.dtype)
            return Surrounded(frames, nothing, np.zeros(count, np.bool_))
        behind = np.searchsorted(others.order, frames.order)
        middle = np.clip(behind, SIDE, len(others.time) - SIDE)
        rows = middle + np.arange(-SIDE, SIDE)[:, None]
        times = np.insert(others.time[rows], SIDE, frames.time, axis=0)
        near = np.abs(np.diff(times, axis=0)) <= self._apart
        return Surrounded(frames, others.data[rows], (middle == behind) & near.all(axis=0))
