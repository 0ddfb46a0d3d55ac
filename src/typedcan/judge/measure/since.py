"""Since when something has been so, frame by frame."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.series import Series


class Since:
    """Goes over the frames of one message.

    Parameters
    ----------
    gap
        Seconds without a frame after which nothing is known of the time between.
    seen
        Whether it counts only where its begin was seen: a frame before at which it was not so.
    """

    def __init__(self, gap: float, *, seen: bool = False) -> None:
        self._gap = gap
        self._seen = seen
        self._held = False
        self._since = math.nan

    def feed(self, series: Series, holds: NDArray[np.bool_]) -> NDArray[np.float64]:
        """The time since when it has been so, for each row; NaN where it is not, or not known.

        Each frame is to be taken once, in their order; ``holds`` says where it is so.
        """
        time, count = series.time, len(series)
        since = np.full(count, np.nan)
        if series.first:
            since[0] = self._since
        if not series.fresh:
            return since
        held = np.empty(count, np.bool_)
        held[0] = self._held if series.first else False
        held[1:] = holds[:-1]
        held[1:][: series.first] = self._held
        near = np.zeros(count, np.bool_)
        near[1:] = np.diff(time) <= self._gap
        begins = holds & ~(held & near)
        begins[: series.first] = False
        starts = np.where(near, time, np.nan) if self._seen else time
        rows = np.maximum.accumulate(np.where(begins, np.arange(count), -1))
        fresh = np.where(rows >= 0, starts[rows], self._since)
        first = series.first
        since[first:] = np.where(holds, fresh, np.nan)[first:]
        self._held, self._since = bool(holds[-1]), float(since[-1])
        return since


def last(
    series: Series, holds: NDArray[np.bool_], what: NDArray[np.float64], before: float
) -> NDArray[np.float64]:
    """For each row what stands at the last one, itself included, where something is so.

    ``before`` is what it is for rows that have none.
    """
    rows = np.maximum.accumulate(np.where(holds, np.arange(len(series)), -1))
    return np.where(rows >= 0, what[rows], before) if len(series) else np.empty(0)
