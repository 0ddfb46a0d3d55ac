"""Rule scale-digits: factor and offset have no more digits than every reader keeps."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject

_MOST = 6
"""Significant digits; some readers print and store what C prints as %g."""


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    for message, signal in subject.protocol.signals():
        for key, value in (("factor", signal.factor), ("offset", signal.offset)):
            digits = len(value.normalize().as_tuple().digits)
            if digits > _MOST:
                text = (
                    f"{key} {value} of {signal.name} has {digits} significant digits: give at most "
                    f"{_MOST}"
                )
                yield Found(places.meaning(signal, key), signal.name, text, message.name)


RULE = Rule("scale-digits", "factor and offset have at most 6 significant digits", _check)
