"""Rule signal-readable: each signal has a factor, and what selects it is in its message.

Bits that lie outside of the message are for signal-inside-message.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.layout import unreadable


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    for message in subject.protocol.messages:
        for signal, reason in unreadable(message):
            key = "start" if signal.factor else "factor"
            where = places.layout(signal, key) if signal.factor else places.meaning(signal, key)
            if "outside" not in reason:
                text = f"{signal.name} of {message.name} cannot be read: {reason}"
                yield Found(where, signal.name, text, message.name)


RULE = Rule(
    "signal-readable", "each signal has a factor and a selector that is there", _check, foreign=True
)
