"""Rule signals-overlap: no bit of a frame belongs to two signals."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from dbcspec.layout import bits
from dbcspec.lint.places import Places, has_room
from dbcspec.lint.rule import Found, Rule, Subject


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    for message in subject.protocol.messages:
        taken = [
            (signal, set(bits(signal))) for signal in message.signals if has_room(message, signal)
        ]
        for (first, first_bits), (second, second_bits) in combinations(taken, 2):
            if shared := first_bits & second_bits:
                text = (
                    f"{second.name} overlaps {first.name} at bit {min(shared)} of {message.name}: "
                    f"correct a start bit or a length"
                )
                yield places.layout(second, "start"), second.name, text


RULE = Rule("signals-overlap", "no bit of a frame belongs to two signals", _check)
