"""Rule signal-inside-message: every bit of a signal lies in the bytes of its message."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.layout import bits
from typedcan.model.soundness import has_room


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    for message, signal in subject.protocol.signals():
        space = 8 * message.length
        if not has_room(message, signal):
            text = (
                f"{signal.name} has {signal.length} bits, but {message.name} has room for 1 to "
                f"{space}: correct the length"
            )
            yield Found(places.layout(signal, "length"), signal.name, text, message.name)
        elif outside := [bit for bit in bits(signal) if not 0 <= bit < space]:
            text = (
                f"{signal.name} takes bit {min(outside)}, but {message.name} has bits 0 to "
                f"{space - 1}: correct the start bit, the length or the byte order"
            )
            yield Found(places.layout(signal, "start"), signal.name, text, message.name)


RULE = Rule(
    "signal-inside-message",
    "every bit of a signal lies in the bytes of its message",
    _check,
    foreign=True,
)
