"""Rule signals-overlap: no bit of a frame belongs to two signals."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from dbcspec.errors import Location
from dbcspec.layout import bits
from dbcspec.lint.rule import Rule, Subject


def _check(subject: Subject) -> Iterator[tuple[Location, str, str]]:
    for message in subject.protocol.messages:
        for first, second in combinations(message.signals, 2):
            if shared := set(bits(first)) & set(bits(second)):
                text = f"{second.name} overlaps {first.name} at bit {min(shared)} of {message.name}"
                yield second.where, second.name, text


RULE = Rule("signals-overlap", "no bit of a frame belongs to two signals", _check)
