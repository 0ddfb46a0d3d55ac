"""Rule signals-overlap: no bit of a frame belongs to two signals.

Signals under different values of one multiplexer share bits rightly; those under a common value
are for branches-overlap.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.soundness import overlaps


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    for message in subject.protocol.messages:
        for first, second, bit in overlaps(message):
            if not first.multiplexer or first.multiplexer != second.multiplexer:
                text = (
                    f"{second.name} overlaps {first.name} at bit {bit} of {message.name}: "
                    f"correct a start bit or a length"
                )
                yield Found(places.layout(second, "start"), second.name, text, message.name)


RULE = Rule("signals-overlap", "no bit of a frame belongs to two signals", _check, foreign=True)
