"""Rule acting-code-chosen: no checksum or counter has codes that act, for they are filled in."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    for message, signal in subject.protocol.signals():
        for what, filled in (("checksum", message.checksum), ("counter", message.counter)):
            if signal.acting and filled and filled.signal == signal.name:
                text = f"{signal.name} is a {what}, which nobody sends in order to act: correct one"
                yield Found(places.acts(message, signal, "signal"), signal.name, text, message.name)


RULE = Rule("acting-code-chosen", "no checksum or counter has codes that act", _check)
