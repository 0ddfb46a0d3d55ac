"""Where a pack was silent for so long that it may be another one since."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from swapcan.messages import B2V_ST1
from swapcan.rules.shared import ANOTHER_PACK
from typedcan.judge.chunk import Chunk
from typedcan.judge.tolerance import Limits


class Silences:
    """Counts the silences of the BMU."""

    def __init__(self, limits: Limits) -> None:
        self._longest = limits.limit(ANOTHER_PACK)
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
        ends = series.order[1:][(steps > self._longest) | (steps < -self._longest)]
        self.is_new = len(ends) > 0
        if self.is_new:
            self._ends = np.concatenate([self._ends, ends])

    def up_to(self, order: NDArray[np.int64]) -> NDArray[np.int64]:
        """How many silences ended up to the frames of these numbers in the log."""
        return np.searchsorted(self._ends, order, side="right").astype(np.int64)
