"""Less to draw without losing what can be seen: points, spans and columns in a bounded number.

The columns of time in which points and spans are put together are a power of two of seconds long
and begin at multiples of it. So each is made of whole shorter ones, and it makes no difference
whether points are thinned once, or again and again while they come.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

COLUMNS = 3000
"""Columns of points at most; half as many at least."""

_MOST_POINTS = 64 * 1024
_MOST_SPANS = 8 * 1024
_PER_COLUMN = 4


def column_length(seconds: float, columns: int) -> float:
    """The shortest length that needs no more columns than these, in seconds."""
    return 2.0 ** math.ceil(math.log2(max(seconds, 1e-6) / columns))


class Points:
    """Points of a curve: in each column the first, the last, the lowest and the highest."""

    def __init__(self) -> None:
        self._parts: list[tuple[NDArray[np.float64], NDArray[np.float64]]] = []
        self._count = 0

    def add(self, time: NDArray[np.float64], value: NDArray[np.float64]) -> None:
        """Add points; values are finite, and not changed afterwards."""
        self._parts.append((time, value))
        self._count += len(time)
        if self._count > _MOST_POINTS:
            self._parts = [self.points()]
            self._count = len(self._parts[0][0])

    def points(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Times and values, ascending in time."""
        if not self._parts:
            return np.empty(0), np.empty(0)
        time = np.concatenate([part[0] for part in self._parts])
        value = np.concatenate([part[1] for part in self._parts])
        if (np.diff(time) < 0).any():
            order = time.argsort(kind="stable")
            time, value = time[order], value[order]
        if len(time) <= COLUMNS:
            return time, value
        kept = _telling(time, value, column_length(float(time[-1] - time[0]), COLUMNS))
        return time[kept], value[kept]


def _telling(
    time: NDArray[np.float64], value: NDArray[np.float64], length: float
) -> NDArray[np.bool_]:
    """Which points have to stay."""
    column = np.floor(time / length)
    new = np.ones(len(time), np.bool_)
    new[1:] = column[1:] != column[:-1]
    starts = np.flatnonzero(new)
    counts = np.diff(np.append(starts, len(time)))
    kept: NDArray[np.bool_] = new | np.append(new[1:], np.True_)
    kept |= np.repeat(counts <= _PER_COLUMN, counts)
    for extreme in (np.minimum, np.maximum):
        at = np.flatnonzero(value == np.repeat(extreme.reduceat(value, starts), counts))
        within = np.searchsorted(starts, at, side="right")
        kept[at[np.unique(within, return_index=True)[1]]] = True
    return kept


class SpanList:
    """Spans of time; in each column those that are close together become one."""

    def __init__(self) -> None:
        self._parts: list[NDArray[np.float64]] = []
        self._count = 0

    def add(self, begins: NDArray[np.float64], ends: NDArray[np.float64]) -> None:
        """Add spans; those that end before they begin are left out: a clock was set back."""
        forward = ends >= begins
        if not forward.all():
            begins, ends = begins[forward], ends[forward]
        self._parts.append(np.stack([begins, ends], axis=1))
        self._count += len(begins)
        if self._count > _MOST_SPANS:
            self._parts = [self.spans()]
            self._count = len(self._parts[0])

    def spans(self) -> NDArray[np.float64]:
        """Begins and ends, shape (n, 2), ascending and apart from each other."""
        if not self._count:
            return np.empty((0, 2))
        spans = np.concatenate(self._parts)
        spans = spans[spans[:, 0].argsort(kind="stable")]
        closest = 0.0
        if len(spans) > COLUMNS:
            closest = column_length(float(spans[:, 1].max() - spans[0, 0]), COLUMNS)
        ends = np.maximum.accumulate(spans[:, 1])
        apart = np.ones(len(spans), np.bool_)
        apart[1:] = spans[1:, 0] > ends[:-1] + closest
        starts = np.flatnonzero(apart)
        lasts = np.append(starts[1:], len(spans)) - 1
        return np.stack([spans[starts, 0], ends[lasts]], axis=1)


def begins_anew(time: NDArray[np.float64], marks: list[NDArray[np.float64]]) -> NDArray[np.bool_]:
    """Whether before a point there is a mark, behind the point before; true for the first."""
    anew = np.zeros(len(time), np.bool_)
    anew[:1] = True
    for spans in marks:
        if len(spans) and len(time):
            # The first span that ends behind the point before.
            next_span = np.searchsorted(spans[:, 1], time[:-1], side="right")
            begin = np.append(spans[:, 0], np.inf)[next_span]
            anew[1:] |= begin < time[1:]
    return anew
