"""How many readings each group has: announced, fixed, or shown by what arrives."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from typedcan.model.transfer import Numbering
from typedcan.model.transfers.kind import MOST_ITEMS
from typedcan.model.transfers.parts import Parts


@dataclass(frozen=True, slots=True)
class Totals:
    """How many groups and how many readings there are, as the sender says."""

    groups: int
    count: int


class Shape(Protocol):
    """The number of readings of each group, as far as it is known. Groups count from 1."""

    forgettable: bool
    """Whether after a silence it has to be found out anew by who made it."""

    is_fixed: bool
    """Whether a frame beyond the readings of its group is none that there is."""

    @property
    def is_certain(self) -> bool:
        """Whether the numbers are known, not taken to be."""
        ...

    @property
    def is_contradicted(self) -> bool:
        """Whether more has come than there can be."""
        ...

    @property
    def seen(self) -> int:
        """How many readings are known to be there."""
        ...

    def has(self, group: int) -> bool:
        """Whether there is such a group."""
        ...

    def before(self, group: int) -> int:
        """How many frame numbers are those of groups before this one."""
        ...

    def limit(self, group: int) -> int:
        """Readings beyond this one that have no value are nothing but fill."""
        ...

    def see(self, group: int, highest: int) -> bool:
        """Note the highest reading with a value in a frame; whether it says anything new."""
        ...

    def known(self, group: int) -> int:
        """The highest reading of which `see` says that it is nothing new."""
        ...

    def counts(self) -> Mapping[int, int] | None:
        """The number of readings of each group, or None while it is not known."""
        ...

    def anew(self) -> Shape:
        """The same before any frame came."""
        ...


class TotalsShape(Shape):
    """The shape of a sender that tells its totals.

    The highest reading with a value that a group ever sent is at most the number that it has. Where
    these add up to the total, each of them is exactly that number: nothing was missed. Before
    that, all groups whose total they divide are taken to have the same number, as long
    as no reading speaks against it.
    """

    forgettable = False
    is_fixed = False

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

    def has(self, group: int) -> bool:
        """Whether the sender counts so many groups."""
        return 1 <= group <= self.totals.groups

    def before(self, group: int) -> int:
        """None: each group numbers its own frames."""
        del group
        return 0

    def limit(self, group: int) -> int:
        """No group has more readings than there are in all."""
        del group
        return self.totals.count

    def see(self, group: int, highest: int) -> bool:
        """Note the highest reading with a value in a frame; whether it says anything new."""
        known = self._highest.get(group, 0)
        if highest <= known:
            return False
        self._highest[group] = highest
        self._seen += highest - known
        return True

    def known(self, group: int) -> int:
        """The highest reading with a value that a group ever sent; 0 where it sent none."""
        return self._highest.get(group, 0)

    def counts(self) -> Mapping[int, int] | None:
        """The number of readings of each group, or None while it is not known."""
        groups = range(1, self.totals.groups + 1)
        if self.is_certain:
            return {group: self._highest.get(group, 0) for group in groups}
        each, rest = divmod(self.totals.count, self.totals.groups)
        if rest or any(highest > each for highest in self._highest.values()):
            return None
        return dict.fromkeys(groups, each)

    def anew(self) -> TotalsShape:
        """The same before any frame came."""
        return TotalsShape(self.totals)


class FixedShape(Shape):
    """A shape that is known.

    Parameters
    ----------
    counts
        The number of readings of each group.
    before
        How many frame numbers are those of groups before it; empty where each numbers its own.
    surplus
        How many frames beyond the numbers show that there is more.
    forgettable
        Whether after a silence it has to be found out anew.
    """

    def __init__(
        self,
        counts: Mapping[int, int],
        before: Mapping[int, int] | None = None,
        *,
        surplus: int = 1,
        forgettable: bool = False,
    ) -> None:
        self.forgettable = forgettable
        self.is_fixed = not forgettable
        self._counts = dict(counts)
        self._before = dict(before or {})
        self._most = surplus
        self._surplus = 0

    @property
    def seen(self) -> int:
        """All of them."""
        return sum(self._counts.values())

    @property
    def is_certain(self) -> bool:
        """It is known."""
        return True

    @property
    def is_contradicted(self) -> bool:
        """Whether frames came that it has not."""
        return self._surplus >= self._most

    def has(self, group: int) -> bool:
        """Whether there is such a group; one that was not seen is surplus."""
        return group >= 1 if self.forgettable else group in self._counts

    def before(self, group: int) -> int:
        """The frame numbers of groups before this one."""
        return self._before.get(group, 0)

    def limit(self, group: int) -> int:
        """The readings of the group."""
        return self._counts.get(group, 0)

    def see(self, group: int, highest: int) -> bool:
        """Whether this frame is one too many."""
        if highest <= self._counts.get(group, 0):
            return False
        self._surplus += 1
        return self.is_contradicted

    def known(self, group: int) -> int:
        """The readings of the group."""
        return self._counts.get(group, 0)

    def counts(self) -> Mapping[int, int]:
        """The number of readings of each group."""
        return self._counts

    def anew(self) -> FixedShape:
        """The same before any surplus frame came."""
        return FixedShape(
            self._counts, self._before, surplus=self._most, forgettable=self.forgettable
        )


def numbered_through(counts: Mapping[int, int], width: int) -> dict[int, int]:
    """By group, the frames of all groups before it, each with ``width`` readings."""
    before: dict[int, int] = {}
    frames = 0
    for group, count in sorted(counts.items()):
        before[group] = frames
        frames += -(count // -width)
    return before


def totals_of(parts: Parts, values: Sequence[int | None]) -> Totals | None:
    """How much there is; ``values`` has what its signals say, in the order of groups and count.

    None where it is not known: a sender that counts none has not counted yet, and no transfer has
    more than `MOST_ITEMS`.
    """
    transfer = parts.transfer
    if transfer.counts:
        return Totals(len(transfer.counts), sum(transfer.counts))
    rest = iter(values)
    groups = next(rest, None) if parts.groups else transfer.groups
    count = next(rest, None) if parts.count else transfer.count
    if not groups or not count or not (0 < groups <= MOST_ITEMS and 0 < count <= MOST_ITEMS):
        return None
    return Totals(groups, count)


def frames_of(parts: Parts, totals: Totals) -> int:
    """How many frames a cycle has, where all groups are alike."""
    each = -(totals.count // -totals.groups)
    return totals.groups * -(each // -parts.width)


def shape_of(parts: Parts, totals: Totals) -> Shape | str:
    """What is known of the numbers of readings with these totals, or why nothing can be."""
    transfer = parts.transfer
    if transfer.counts:
        counts = dict(enumerate(transfer.counts, 1))
    elif transfer.numbering is Numbering.WITHIN_GROUP:
        return TotalsShape(totals)
    else:
        each, rest = divmod(totals.count, totals.groups)
        if rest:
            whose = f"{totals.count} readings of {totals.groups} {parts.word}s"
            return f"{whose}, and their frames are numbered through: how many each has is not known"
        counts = dict.fromkeys(range(1, totals.groups + 1), each)
    is_through = transfer.numbering is Numbering.THROUGH
    return FixedShape(counts, numbered_through(counts, parts.width) if is_through else None)
