"""Rule unit-known: a unit is spelt as SI or the usage of the field spells it."""

from __future__ import annotations

from collections.abc import Iterator
from difflib import get_close_matches

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from dbcspec.lint.units import is_known, known_units


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    extra = subject.settings.units
    for message, signal in subject.protocol.signals():
        if signal.unit and not is_known(signal.unit, extra):
            text = (
                f"the unit {signal.unit!r} of {signal.name} is not known{_hint(signal.unit, extra)}"
                f": correct it, or add it to units"
            )
            yield Found(places.meaning(signal, "unit"), signal.name, text, message.name)


def _hint(unit: str, extra: frozenset[str]) -> str:
    known = sorted(known_units() | extra)
    same = [each for each in known if each.casefold() == unit.casefold()]
    close = same or get_close_matches(unit, known, n=1, cutoff=0.75)
    return f" (the closest is {close[0]})" if close else ""


RULE = Rule(
    "unit-known",
    "a unit is spelt as SI or the usage of the field spells it",
    _check,
    level="warning",
)
