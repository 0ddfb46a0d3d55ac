"""Statistics of the times between frames, in constant memory."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class PeriodStats:
    """The times between frames so far, in seconds; None where there was none yet.

    Parameters
    ----------
    count
        How many times between frames were measured.
    mean, jitter
        Their mean and standard deviation.
    worst, shortest
        The longest and the shortest.
    """

    count: int = 0
    mean: float | None = None
    jitter: float | None = None
    worst: float | None = None
    shortest: float | None = None


class Periods:
    """Takes the times between frames, one by one.

    Mean and squared deviations are updated as Welford has it: nothing is lost in long runs, where
    sums of times and of their squares would lose digits.
    """

    __slots__ = ("_count", "_deviations", "_mean", "_shortest", "_worst")

    def __init__(self) -> None:
        self._count = 0
        self._mean = 0.0
        self._deviations = 0.0
        self._worst = -math.inf
        self._shortest = math.inf

    def add(self, seconds: float) -> None:
        """Another time between two frames."""
        self._count = count = self._count + 1
        deviation = seconds - self._mean
        self._mean = mean = self._mean + deviation / count
        self._deviations += deviation * (seconds - mean)
        if seconds > self._worst:
            self._worst = seconds
        if seconds < self._shortest:
            self._shortest = seconds

    def stats(self) -> PeriodStats:
        """The statistics so far."""
        if not self._count:
            return PeriodStats()
        jitter = math.sqrt(self._deviations / self._count)
        return PeriodStats(self._count, self._mean, jitter, self._worst, self._shortest)
