"""Count, mean, deviation and extremes of what comes in parts."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Spread:
    """Of some values; those of none are the default.

    Parameters
    ----------
    count, mean
        How many, and their mean.
    square
        The sum of their squared distances from the mean.
    shortest, longest
        The extremes.
    """

    count: int = 0
    mean: float = math.nan
    square: float = 0.0
    shortest: float = math.inf
    longest: float = -math.inf

    @property
    def deviation(self) -> float:
        """The standard deviation; NaN where there are no values."""
        return math.sqrt(self.square / self.count) if self.count else math.nan

    def __add__(self, other: Spread) -> Spread:
        """Of both together: from the distances of their means, so that nothing cancels out."""
        if not self.count or not other.count:
            return self if self.count else other
        count = self.count + other.count
        apart = other.mean - self.mean
        return Spread(
            count,
            self.mean + apart * other.count / count,
            self.square + other.square + apart * apart * self.count * other.count / count,
            min(self.shortest, other.shortest),
            max(self.longest, other.longest),
        )


def spread_of(values: NDArray[np.float64]) -> Spread:
    """The count, mean, deviation and extremes of an array."""
    if not len(values):
        return Spread()
    mean = float(values.mean())
    square = float(np.square(values - mean).sum())
    return Spread(len(values), mean, square, float(values.min()), float(values.max()))
