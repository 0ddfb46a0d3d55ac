"""How many readings each CSC has, as seen in frames."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from typedcan.model.transfers.shape import FixedShape

_SURPLUS = 5
"""How many frames beyond what was seen show that there is more."""

_OFTEN = 0.5
"""Frames that came less often than this, beside the most frequent one, are taken for errors."""


def seen_shape(frames: Iterable[tuple[int, int, int]]) -> FixedShape:
    """The shape that frames show: each its CSC, number, and highest reading with a value."""
    often: Counter[tuple[int, int]] = Counter()
    highest: dict[tuple[int, int], int] = {}
    for csc, number, last in frames:
        if csc >= 1 and number >= 1 and last:
            often[csc, number] += 1
            highest[csc, number] = max(last, highest.get((csc, number), 0))
    enough = _OFTEN * max(often.values(), default=0)
    counts: dict[int, int] = {}
    for (csc, number), last in highest.items():
        if often[csc, number] >= enough:
            counts[csc] = max(last, counts.get(csc, 0))
    return FixedShape(dict(sorted(counts.items())), surplus=_SURPLUS, forgettable=True)
