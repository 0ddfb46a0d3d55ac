"""Where a pack was silent for so long that it may be another one since."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from swapcan.messages import B2V_ST1
from typedcan.judge.chunk import Chunk

_SILENCE = 3.0
"""Seconds without B2V_ST1, which is sent every 100 ms: nobody swaps a pack faster."""


class Silences:
    """Counts the silences of the BMU."""

    def __init__(self) -> None:
        self._ends = np.empty(0, np.int64)
        self.is_new = False
        """Whether one ended in the last chunk."""

    @property
    def count(self) -> int:
        """How many there were."""
        return len(self._ends)

    def feed(self, chunk: Chunk) -> None:
        """Look for silences that end in a chunk."""
        series = chunk.frames(B2V_ST1)
        steps = np.diff(series.time)
        ends = series.order[1:][(steps > _SILENCE) | (steps < -_SILENCE)]
        self.is_new = len(ends) > 0
        if self.is_new:
            self._ends = np.concatenate([self._ends, ends])

    def up_to(self, order: NDArray[np.int64]) -> NDArray[np.int64]:
        """How many silences ended up to the frames of these numbers in the log."""
        return np.searchsorted(self._ends, order, side="right").astype(np.int64)
