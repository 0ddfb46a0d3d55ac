"""The codes of signals before and after, once for all promises that speak of codes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from enum import Enum

from dbcspec.compare.languages import plain
from dbcspec.compare.pairing import Pairing, SignalPair
from dbcspec.compare.promise import Change, Check
from dbcspec.compare.senses import agree, means_no_value
from dbcspec.compare.spec_only import both_are_specs, states
from typedcan.model.naming import member_names
from typedcan.model.protocol import Code, ValueTable

_SHOWN = 4
"""Codes that a text names before it counts the rest; ``old`` and ``new`` have all."""


_MOST_WORDED = 16
"""Codes of a table whose words are weighed against each other: states have few."""


class Difference(Enum):
    """The gravest way in which one code of both sides differs."""

    MEANING = "meaning"
    MEMBER = "member"
    LABEL = "label"


@dataclass(frozen=True, slots=True)
class CodesPair:
    """Different value tables before and after, and the first signal that has them.

    ``others`` are further signals with the same two tables: the change is one and told once.
    """

    signal: SignalPair
    others: tuple[SignalPair, ...]
    old: Mapping[int, Code]
    new: Mapping[int, Code]

    def change(self, text: str, old: str, new: str) -> Change:
        """A change of these codes."""
        more = f", also of {len(self.others)} more signals" if len(self.others) > 1 else ""
        more = ", also of 1 more signal" if len(self.others) == 1 else more
        return Change(
            message=self.signal.new_message.name,
            subject=self.signal.new.name,
            text=text + more,
            old=old,
            new=new,
            where=self.signal.new.where,
        )


def code_pairs(pairing: Pairing) -> Iterator[CodesPair]:
    """Each pair of value tables that differ in a code, in the order of their first signals."""
    for signals in pairing.signals_by_tables:
        old, new = signals[0].old.value_table, signals[0].new.value_table
        yield CodesPair(signals[0], signals[1:], _by_value(old), _by_value(new))


def differing_in(difference: Difference, word: str, show: Callable[[Code, str], str]) -> Check:
    """A check over the codes of both sides that differ in just that way.

    ``show`` gives a code and the name of its member in generated code as people shall see it.
    """

    def check(pairing: Pairing) -> Iterator[Change]:
        for codes in code_pairs(pairing):
            before, after = _members(codes.old), _members(codes.new)
            changed_places = reversed_codes(pairing, codes)
            shown = [
                (value, show(codes.old[value], before[value]), show(codes.new[value], after[value]))
                for value, way in _differences(pairing, codes).items()
                if way is difference and value not in changed_places
            ]
            if shown:
                steps = [f"{value} {was} → {now}" for value, was, now in shown]
                old = "; ".join(f"{value} {was}" for value, was, _ in shown)
                new = "; ".join(f"{value} {now}" for value, _, now in shown)
                yield codes.change(f"{word} {shortened(steps)}", old, new)

    return check


def reversed_codes(pairing: Pairing, codes: CodesPair) -> frozenset[int]:
    """The codes that have changed places with another: each means what the other meant."""
    common = [value for value in codes.old if value in codes.new]
    different = [
        value
        for value in common
        if not pairing.languages.same_meaning(codes.old[value], codes.new[value])
    ]
    if len(different) < 2:
        return frozenset()
    places: dict[str, list[int]] = {}
    for value in different:
        for text in _texts(codes.new[value]):
            places.setdefault(text, []).append(value)
    moved = {
        (value, other)
        for value in different
        for text in _texts(codes.old[value])
        for other in places.get(text, [])[:_MOST_WORDED]
    }
    if len(different) <= _MOST_WORDED:
        moved.update(
            (value, other)
            for value in different
            for other in different
            if agree(_worded(codes.old[value]), _worded(codes.new[other]))
        )
    return frozenset(value for value, other in moved if value != other and (other, value) in moved)


def _texts(code: Code) -> set[str]:
    return {plain(code.label), plain(code.english)} - {""}


def _worded(code: Code) -> str:
    return code.english or code.label


def one_sided(codes: CodesPair, pairing: Pairing, *, removed: bool) -> list[Code]:
    """The codes that the new side lacks, or has more.

    A code that is the invalid or abnormal one on its side alone belongs to the promise over
    those.
    """
    here, there = (codes.old, codes.new) if removed else (codes.new, codes.old)
    left_out: set[int] = set()
    if both_are_specs(pairing):
        before, after = states(codes.signal.old), states(codes.signal.new)
        left_out = before - after if removed else after - before
    else:
        left_out = {
            code.value for code in here.values() if means_no_value(code.english or code.label)
        }
    return [code for value, code in here.items() if value not in there and value not in left_out]


def quoted(code: Code) -> str:
    """A label in quotes."""
    return f'"{code.english or code.label}"'


def both_labels(code: Code) -> str:
    """A label in quotes, in English and as printed where these differ."""
    printed = f' ("{code.label}")' if code.label != code.english else ""
    return f'"{code.english}"{printed}'


def shortened(parts: Iterable[str]) -> str:
    """The first few of many parts and how many more there are."""
    every = list(parts)
    more = f" and {len(every) - _SHOWN} more" if len(every) > _SHOWN else ""
    return ", ".join(every[:_SHOWN]) + more


def _by_value(table: ValueTable | None) -> dict[int, Code]:
    return {code.value: code for code in table.codes} if table else {}


def _differences(pairing: Pairing, codes: CodesPair) -> dict[int, Difference]:
    languages = pairing.languages
    common = [value for value in codes.old if value in codes.new]
    found: dict[int, Difference] = {}
    for value in common:
        old, new = codes.old[value], codes.new[value]
        if not languages.same_meaning(old, new):
            found[value] = Difference.MEANING
        elif not languages.same((old.label, old.english), (new.label, new.english)):
            found[value] = Difference.LABEL
    if languages.alike and not languages.translated:
        before, after = _members(codes.old), _members(codes.new)
        for value in common:
            if before[value] != after[value] and found.get(value) is not Difference.MEANING:
                found[value] = Difference.MEMBER
    return dict(sorted(found.items()))


def _members(codes: Mapping[int, Code]) -> dict[int, str]:
    return member_names([(value, code.english) for value, code in codes.items()])
