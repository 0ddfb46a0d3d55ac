"""Sums over time, from one chunk to the next."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from swapcan.rules.pack.runs import ROUNDING
from swapcan.rules.shared import SUMMED_OVER
from typedcan.judge.tolerance import Limits

Numbers = NDArray[np.float64]


class Integral:
    """The running integrals of several values over one series of times, without gaps in between.

    Parameters
    ----------
    count
        How many values.
    """

    def __init__(self, count: int, limits: Limits) -> None:
        self.longest = limits.limit(SUMMED_OVER)
        """Seconds between two rows that are summed over; a longer pause is a gap."""
        self.totals: Numbers = np.zeros(count)
        """The integrals up to the last row; what is of interest is how they grow."""
        self.gaps = 0
        """The gaps up to the last row: pauses, and values that are missing or not to be joined."""
        self._time = np.full(1, np.nan)
        self._values = np.full((1, count), np.nan)

    def feed(
        self, time: Numbers, values: Numbers, apart: NDArray[np.bool_] | None = None
    ) -> tuple[Numbers, NDArray[np.int64]]:
        """The integrals and the gaps up to each row, shapes (rows, count) and (rows,).

        Parameters
        ----------
        time
            Of the new rows, at least one, in seconds.
        values
            Shape (rows, count), NaN where there is none.
        apart
            Rows that are not to be joined with the one before.
        """
        time = np.concatenate([self._time, time])
        values = np.concatenate([self._values, values])
        self._time, self._values = time[-1:].copy(), values[-1:].copy()
        steps = np.diff(time)
        growth = (values[1:] + values[:-1]) / 2 * steps[:, None]
        gap = ~((steps >= 0) & (steps <= self.longest + ROUNDING)) | np.isnan(growth).any(axis=1)
        if apart is not None:
            gap |= apart
        growth[gap] = 0.0
        totals = self.totals + np.cumsum(growth, axis=0)
        gaps = self.gaps + np.cumsum(gap)
        self.totals, self.gaps = totals[-1].copy(), int(gaps[-1])
        return totals, gaps
