"""How regularly each message came, for the plots of a report."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from swapcan.conform.chunk import Chunk

COLUMNS = 600
"""Spans that a log is cut into for a plot."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Periods:
    """How regularly a message came.

    Parameters
    ----------
    message
        Its name.
    period
        What the standard prints, in seconds.
    frames
        How many came.
    mean, deviation, shortest, longest
        Seconds between two frames that carry the same; NaN where there are no two.
    time, low, high
        Seconds since the log's begin of up to `COLUMNS` spans of equal length, and the shortest
        and longest step that ended in each; spans without are left out.
    """

    message: str
    period: float
    frames: int
    mean: float
    deviation: float
    shortest: float
    longest: float
    time: NDArray[np.float64]
    low: NDArray[np.float64]
    high: NDArray[np.float64]


class PeriodMeter:
    """Measures the steps between the frames of one log."""

    def take(self, chunk: Chunk) -> None:
        """Measure the next frames."""

    def finish(self, end: float) -> tuple[Periods, ...]:
        """One per message that has a period and came, in the standard's order."""
        return ()
