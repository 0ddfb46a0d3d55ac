"""In which reading of its spec readings by group are sent: told by their frames.

Readings of a spec may differ in what the numbers of frames count, and in how many frames come in a
period. Numbers that go on where the group steps count through all groups; a group after the first
that begins with the first number counts its own. Steps of about a period say one frame a period.
Live nodes and columns go by the same evidence, and by the same candidates.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from itertools import product
from typing import Any

from typedcan.model.protocol import Protocol
from typedcan.model.transfer import Numbering, Pace, Transfer
from typedcan.model.transfers.parts import Parts
from typedcan.model.variants import erratum_of

_FACTS: Mapping[str, type[Enum]] = {"numbering": Numbering, "pace": Pace}
"""What frames tell of a transfer."""

_USUAL: Mapping[str, Enum] = {"numbering": Numbering.THROUGH, "pace": Pace.ALL_IN_PERIOD}
"""What a transfer has that says nothing of it."""

SLOW = 0.75
"""Shares of a period from which on a step is one to the next period."""

_STEPS = 4
"""Slow steps that are needed to say that one frame comes in a period."""

_RARELY = 3
"""Quick steps are so much rarer than slow ones where one frame comes in a period."""


_DOUBT = 2
"""What has to speak against a reading that was right before."""


@dataclass(frozen=True, slots=True)
class Candidate:
    """A transfer in one reading of its spec.

    Parameters
    ----------
    parts
        The transfer, as it is read then.
    about
        The ids of the readings, each with what of a transfer it says.
    """

    parts: Parts
    about: tuple[tuple[str, frozenset[str]], ...] = ()

    def told(self, facts: Mapping[str, Enum]) -> tuple[str, ...]:
        """The ids of the readings that are recognised where so much is known.

        One an erratum, in the same order for all candidates; "" where it is not known.
        """
        return tuple(name if own <= facts.keys() else "" for name, own in self.about)


@dataclass(slots=True)
class Evidence:
    """What frames have told so far of the reading in which they are sent.

    Parameters
    ----------
    through
        How often numbers went on where the group stepped.
    within
        How often a group after the first had the first number.
    slow, quick
        How often a frame came about a period after the one before, and how often sooner.
    """

    through: int = 0
    within: int = 0
    slow: int = 0
    quick: int = 0

    @classmethod
    def of(cls, transfer: Transfer) -> Evidence:
        """A little, for the reading that was right before."""
        is_through = transfer.numbering is Numbering.THROUGH
        is_slow = transfer.pace is Pace.ONE_A_PERIOD
        return cls(
            through=_DOUBT * is_through,
            within=_DOUBT * (not is_through),
            slow=_STEPS * is_slow,
            quick=_DOUBT * (not is_slow),
        )

    def see(
        self, last: tuple[int, int, float] | None, this: tuple[int, int, float], slow: float
    ) -> None:
        """Take a frame and the one before: group and number, both from 0, and the time.

        ``slow`` is the step in seconds from which on it is one to the next period.
        """
        group, number, at = this
        if group > 0 and number == 0:
            self.within += 1
        if last is None or last[:2] == this[:2]:
            return
        if group == last[0] + 1 and number == last[1] + 1:
            self.through += 1
        if at - last[2] >= slow:
            self.slow += 1
        else:
            self.quick += 1

    @property
    def facts(self) -> dict[str, Enum]:
        """What is known of the transfer."""
        found: dict[str, Enum] = {}
        if self.through != self.within:
            through = self.through > self.within
            found["numbering"] = Numbering.THROUGH if through else Numbering.WITHIN_GROUP
        if self.slow >= _STEPS and self.slow > _RARELY * self.quick:
            found["pace"] = Pace.ONE_A_PERIOD
        elif self.quick:
            found["pace"] = Pace.ALL_IN_PERIOD
        return found


def candidates_of(parts: Parts) -> tuple[Candidate, ...]:
    """The readings of a transfer that frames can tell apart, the usual one first.

    One where there is nothing to be told. What was chosen is not asked again.
    """
    errata = _differences(parts.protocol, parts.transfer)
    found: list[Candidate] = []
    for chosen in product(*(readings.items() for readings in errata.values())):
        facts = {key: value for _, own in chosen for key, value in own.items()}
        transfer = replace(parts.transfer, **facts)
        if transfer not in [each.parts.transfer for each in found]:
            about = tuple(
                (name, frozenset(key for own in errata[number].values() for key in own))
                for number, (name, _) in zip(errata, chosen, strict=True)
            )
            same = transfer == parts.transfer
            found.append(Candidate(parts if same else Parts(transfer, parts.protocol), about))
    return tuple(found)


def agreeing(candidates: tuple[Candidate, ...], facts: Mapping[str, Enum]) -> Iterator[int]:
    """Which of the candidates are as the frames tell."""
    for place, each in enumerate(candidates):
        transfer = each.parts.transfer
        if all(getattr(transfer, key) is value for key, value in facts.items()):
            yield place


def both(before: Sequence[str], told: Sequence[str]) -> str:
    """Where readings are others than those before, what there is to say; else empty."""
    pairs = [(a, b) for a, b in zip(before, told, strict=False) if a and b and a != b]
    old, new = (", ".join(each) for each in zip(*pairs, strict=True)) if pairs else ("", "")
    return f"sent as {new} has it, before as {old}" if pairs else ""


def told_apart(candidates: tuple[Candidate, ...]) -> frozenset[str]:
    """The facts in which candidates differ."""
    first = candidates[0].parts.transfer
    return frozenset(
        key
        for key in _FACTS
        for each in candidates
        if getattr(each.parts.transfer, key) is not getattr(first, key)
    )


def _differences(protocol: Protocol, transfer: Transfer) -> dict[str, dict[str, dict[str, Any]]]:
    """By erratum and reading, what is read otherwise of a transfer."""
    found: dict[str, dict[str, dict[str, Any]]] = {}
    taken = {erratum_of(protocol, name) for name in _chosen(protocol)}
    start = f"transfers/{transfer.name}/"
    for each in protocol.variants:
        if each.is_edition or start not in each.changes:
            continue
        number = erratum_of(protocol, each.name)
        facts = {
            path.removeprefix(start): value
            for path, value in json.loads(each.changes)
            if path.startswith(start)
        }
        own = {
            key: kind[facts[key]] if facts[key] else _USUAL[key]
            for key, kind in _FACTS.items()
            if key in facts
        }
        if number and number not in taken and own:
            found.setdefault(number, {number: {}})[each.name] = own
    return found


def _chosen(protocol: Protocol) -> set[str]:
    """The readings that are chosen, those of an edition among them."""
    names = set(protocol.chosen.split("+"))
    editions = [each for each in protocol.variants if each.is_edition and each.name in names]
    return names.union(*(each.readings for each in editions))
