"""How many readings each group has: the sender tells the sum, the rest shows in what arrives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Totals:
    """How many groups and how many readings there are, as the sender says."""

    groups: int
    count: int


class Shape:
    """The number of readings of each group, as far as it is known.

    The highest reading with a value that a group ever sent is at most the number that it has. Where
    these add up to the total, each of them is exactly that number: nothing was missed. Before
    that, all groups whose total they divide are taken to have the same number, as long
    as no reading speaks against it.
    """

    def __init__(self, totals: Totals) -> None:
        self.totals = totals
        self._highest: dict[int, int] = {}
        self._seen = 0

    @property
    def seen(self) -> int:
        """How many readings are known to be there."""
        return self._seen

    @property
    def is_certain(self) -> bool:
        """Whether the numbers are known, not taken to be."""
        return self._seen == self.totals.count

    @property
    def is_contradicted(self) -> bool:
        """Whether there are more readings than the total."""
        return self._seen > self.totals.count

    def highest(self, group: int) -> int:
        """The highest reading with a value that a group ever sent; 0 where it sent none."""
        return self._highest.get(group, 0)

    def see(self, group: int, highest: int) -> bool:
        """Note the highest reading with a value in a frame; whether it says anything new."""
        known = self._highest.get(group, 0)
        if highest <= known:
            return False
        self._highest[group] = highest
        self._seen += highest - known
        return True

    def counts(self) -> Mapping[int, int] | None:
        """The number of readings of each group, or None while it cannot be told."""
        groups = range(1, self.totals.groups + 1)
        if self.is_certain:
            return {group: self._highest.get(group, 0) for group in groups}
        each, rest = divmod(self.totals.count, self.totals.groups)
        if rest or any(highest > each for highest in self._highest.values()):
            return None
        return dict.fromkeys(groups, each)
