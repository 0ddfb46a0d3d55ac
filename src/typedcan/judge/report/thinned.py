"""Points of a curve in a bounded number."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

MOST = 2000
"""Points that are kept at most."""

_HELD = 4 * MOST


class Points:
    """Times and values; where they are too many, the lowest and the highest of each group stay."""

    def __init__(self) -> None:
        self._time = np.empty(0)
        self._value = np.empty(0)

    def add(self, time: NDArray[np.float64], value: NDArray[np.float64]) -> None:
        """Add points; they are copied, and a value may be NaN."""
        self._time = np.concatenate([self._time, time])
        self._value = np.concatenate([self._value, value])
        if len(self._time) > _HELD:
            self._thin()

    @property
    def time(self) -> NDArray[np.float64]:
        """Their times, in the order in which they came."""
        self._thin()
        return self._time

    @property
    def value(self) -> NDArray[np.float64]:
        """Their values."""
        self._thin()
        return self._value

    def _thin(self) -> None:
        count = len(self._time)
        if count <= MOST:
            return
        kept: set[int] = set()
        for group in np.array_split(np.arange(count), MOST // 2):
            value = self._value[group]
            lowest = np.argmin(np.where(np.isnan(value), np.inf, value))
            highest = np.argmax(np.where(np.isnan(value), -np.inf, value))
            kept |= {int(group[lowest]), int(group[highest])}
        rows = np.array(sorted(kept))
        self._time, self._value = self._time[rows], self._value[rows]
