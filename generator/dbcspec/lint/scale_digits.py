"""Rule scale-digits: factor and offset have no more digits than every reader keeps."""

from __future__ import annotations

from collections.abc import Iterator
from decimal import Decimal

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject

_MOST = 6
"""Significant digits; some readers print and store what C prints as %g."""


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    for message, signal in subject.protocol.signals():
        for key, value in (("factor", signal.factor), ("offset", signal.offset)):
            digits = len(value.normalize().as_tuple().digits)
            if digits > _MOST and not _is_power_of_two(value):
                text = (
                    f"{key} {value} of {signal.name} has {digits} significant digits: give at most "
                    f"{_MOST}"
                )
                yield Found(places.meaning(signal, key), signal.name, text, message.name)


def _is_power_of_two(value: Decimal) -> bool:
    """Whether it is ½, ¼ and so on, which is exact in binary however many digits it has."""
    above, below = abs(value).as_integer_ratio()
    return above == 1 and below & (below - 1) == 0


RULE = Rule(
    "scale-digits", "factor and offset have at most 6 significant digits", _check, level="warning"
)
