"""In which reading of its spec readings by group are sent: told by their frames.

Readings of a spec may differ in what the numbers of frames count, and in how many frames come in a
period. Numbers that go on where the group steps count through all groups; a group after the first
that begins with the first number counts its own. Steps of about a period say one frame a period.
Live nodes and columns go by the same evidence, and by the same candidates.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from itertools import product
from typing import Any

from typedcan.model.protocol import Protocol
from typedcan.model.transfer import Numbering, Pace, Transfer
from typedcan.model.transfers.parts import Parts
from typedcan.model.variants import changes_of, erratum_of

_FACTS: Mapping[str, type[Enum]] = {"numbering": Numbering, "pace": Pace}
"""What frames tell of a transfer."""

_USUAL: Mapping[str, Enum] = {"numbering": Numbering.THROUGH, "pace": Pace.ALL_IN_PERIOD}
"""What a transfer has that says nothing of it."""

_SLOW = 0.75
"""Shares of a period from which on a step is one to the next period."""

_FIRST: Mapping[Enum, int] = {Pace.ONE_A_PERIOD: 4, Numbering.THROUGH: 2}
"""How often in a row it has to be said at first, where once may be chance."""

_PATIENCE = 512
"""More frames are not waited for until it is known how to take them."""

_AGAIN = 5
"""How often in a row it has to be said otherwise than before."""


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
class Said:
    """What frames say of one fact: the first word counts, another one where it is repeated.

    Parameters
    ----------
    known
        What is known; None as long as nothing is.
    other, times
        What was said otherwise since, and how often in a row.
    """

    known: Enum | None = None
    other: Enum | None = None
    times: int = 0

    def hear(self, value: Enum) -> None:
        """Take what a frame says."""
        if value is self.known:
            self.times = 0
            return
        self.times = self.times + 1 if value is self.other else 1
        self.other = value
        if self.times >= needed(value, self.known):
            self.known, self.times = value, 0


def slow_step(parts: Parts) -> float:
    """The step in seconds from which on it is one to the next period of the messages."""
    return _SLOW * max(filter(None, (each.period for each in parts.messages)), default=0) / 1000


def needed(value: Enum, known: Enum | None) -> int:
    """How often in a row something has to be said before it counts."""
    if known is not None:
        return _AGAIN
    return _FIRST.get(value, 1)


class Evidence:
    """What frames have told so far of the reading in which they are sent.

    Parameters
    ----------
    differ
        What is to be told, as `told_apart` has it.
    slow
        The step in seconds from which on it is one to the next period.
    """

    def __init__(self, differ: frozenset[str], slow: float) -> None:
        self.slow = slow
        self.said = {key: Said() for key in sorted(differ)}
        self.has_groups = False
        """Whether frames of several groups were seen."""
        self.frames = 0
        """How many frames were seen."""

    def see(self, last: tuple[int, int, float] | None, this: tuple[int, int, float]) -> None:
        """Take a frame and the one before: group and number, both from 0, and the time."""
        self.frames += 1
        group, number, at = this
        numbers, pace = self.said.get("numbering"), self.said.get("pace")
        if last is not None and last[0] != group:
            self.has_groups = True
        if numbers:
            if group > 0 and number == 0:
                numbers.hear(Numbering.WITHIN_GROUP)
            elif last is not None and (group, number) == (last[0] + 1, last[1] + 1):
                numbers.hear(Numbering.THROUGH)
        if pace and last is not None and last[:2] != this[:2]:
            is_slow = at - last[2] >= self.slow
            pace.hear(Pace.ONE_A_PERIOD if is_slow else Pace.ALL_IN_PERIOD)

    @property
    def facts(self) -> dict[str, Enum]:
        """What is known of the transfer."""
        return {key: each.known for key, each in self.said.items() if each.known is not None}

    @property
    def pending(self) -> frozenset[str]:
        """What will soon be known of how to take what has come."""
        if self.frames > _PATIENCE:
            return frozenset()
        return frozenset(
            key
            for key, each in self.said.items()
            if each.known is None and (self.has_groups if key == "numbering" else each.times)
        )


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
            for path, value in changes_of(each)
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
