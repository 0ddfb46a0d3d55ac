"""How many readings each CSC has: as the pack's totals and its frames say, or as seen."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Protocol

from typedcan.transfer.shape import Shape as PackShape

_SURPLUS = 5
"""How many frames beyond what was seen show that there is more."""

_OFTEN = 0.5
"""Frames that came less often than this, beside the most frequent one, are taken for errors."""


class Shape(Protocol):
    """The number of readings of each CSC, as far as it is known."""

    forgettable: bool
    """Whether after a silence it has to be found out anew by who made it."""

    @property
    def is_certain(self) -> bool:
        """Whether the numbers are known, not taken to be."""
        ...

    @property
    def is_contradicted(self) -> bool:
        """Whether more has come than there can be."""
        ...

    def has(self, csc: int) -> bool:
        """Whether there is such a CSC."""
        ...

    def limit(self, csc: int) -> int:
        """Readings beyond this one that have no value are nothing but fill."""
        ...

    def see(self, csc: int, highest: int, /) -> bool:
        """Note the highest reading with a value in a frame; whether it says anything new."""
        ...

    def known(self, csc: int) -> int:
        """The highest reading of which `see` says that it is nothing new."""
        ...

    def counts(self) -> Mapping[int, int] | None:
        """The number of readings of each CSC, or None while it cannot be told."""
        ...

    def anew(self) -> Shape:
        """The same before any frame came."""
        ...


class TotalsShape(PackShape):
    """The shape of a pack that tells its totals, by the rules of the live runtime."""

    forgettable = False

    def has(self, csc: int) -> bool:
        """Whether the pack counts so many."""
        return 1 <= csc <= self.totals.groups

    def limit(self, csc: int) -> int:
        """No CSC has more readings than there are in all."""
        del csc
        return self.totals.count

    def known(self, csc: int) -> int:
        """The highest reading that has had a value."""
        return self.highest(csc)

    def anew(self) -> TotalsShape:
        """The same before any frame came."""
        return TotalsShape(self.totals)


class SeenShape(Shape):
    """The shape of a pack that was watched for a while.

    Parameters
    ----------
    counts
        The number of readings of each CSC.
    """

    forgettable = True

    def __init__(self, counts: Mapping[int, int]) -> None:
        self._counts = dict(counts)
        self._surplus = 0

    @property
    def is_certain(self) -> bool:
        """What was seen counts."""
        return True

    @property
    def is_contradicted(self) -> bool:
        """Whether several frames came that it has not."""
        return self._surplus >= _SURPLUS

    def has(self, csc: int) -> bool:
        """All numbers from 1: what was not seen is surplus."""
        return csc >= 1

    def limit(self, csc: int) -> int:
        """What was seen of the CSC."""
        return self._counts.get(csc, 0)

    def see(self, csc: int, highest: int) -> bool:
        """Whether this frame is one too many."""
        if highest <= self._counts.get(csc, 0):
            return False
        self._surplus += 1
        return self.is_contradicted

    def known(self, csc: int) -> int:
        """What was seen of the CSC."""
        return self._counts.get(csc, 0)

    def counts(self) -> Mapping[int, int]:
        """What was seen."""
        return self._counts

    def anew(self) -> SeenShape:
        """The same before any surplus frame came."""
        return SeenShape(self._counts)


def seen_shape(frames: Iterable[tuple[int, int, int]]) -> SeenShape:
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
    return SeenShape(dict(sorted(counts.items())))


def frames_in(count: int, width: int) -> range:
    """The frame numbers of a CSC with so many readings, ``width`` in a frame."""
    return range(1, math.ceil(count / width) + 1)
