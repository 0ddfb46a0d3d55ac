"""When identifiers were seen, over a whole log."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.chunk import Chunk
from typedcan.judge.measure.left_over import LeftOver

LISTED = 1000
"""Identifiers that are followed one by one: a log of random ones must not fill the memory."""


@dataclass(slots=True)
class Sighting:
    """The frames of one identifier: its key, the first and last of them, and how many.

    ``start`` and ``end`` are seconds since the log's begin, ``order`` the first one's number in
    the log.
    """

    key: int
    start: float
    end: float
    order: int
    frames: int = 0


class Sightings:
    """Follows the identifiers that come first; ``others`` counts the frames of further ones."""

    def __init__(self) -> None:
        self.others = 0
        self._found: dict[int, Sighting] = {}

    def feed(self, chunk: Chunk, left: LeftOver, which: NDArray[np.bool_]) -> None:
        """Count the frames of some of the identifiers that are left over."""
        if not which.any():
            return
        counts = np.diff(left.bounds)
        followed = self._followed(left, which)
        self.others += int(counts[which].sum() - counts[followed].sum())
        for place in followed.tolist():
            first, last = left.rows[left.bounds[place]], left.rows[left.bounds[place + 1] - 1]
            key = int(left.keys[place])
            end = float(chunk.block.timestamp[last]) - chunk.begin
            if key not in self._found:
                start = float(chunk.block.timestamp[first]) - chunk.begin
                self._found[key] = Sighting(key, start, end, int(first) + chunk.first_order)
            self._found[key].end = end
            self._found[key].frames += int(counts[place])

    def all(self) -> tuple[Sighting, ...]:
        """Those that were followed, by their first frames."""
        return tuple(sorted(self._found.values(), key=lambda each: each.order))

    def _followed(self, left: LeftOver, which: NDArray[np.bool_]) -> NDArray[np.int64]:
        """Places of those that are followed already, or from now on."""
        known = np.fromiter(self._found, np.uint32, len(self._found))
        at = np.minimum(np.searchsorted(left.keys, known), len(left.keys) - 1)
        old: NDArray[np.int64] = at[(left.keys[at] == known) & which[at]]
        room = LISTED - len(self._found)
        if not room:
            return old
        fresh = which.copy()
        fresh[old] = False
        new = np.flatnonzero(fresh)
        first_come = np.argsort(left.rows[left.bounds[new]])[:room]
        return np.concatenate([old, new[first_come]])
