"""Rule period-given: a message that is sent periodically has its period."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.protocol import SendType

_PERIODIC = {SendType.CYCLIC: "always", SendType.IF_ACTIVE: "while its condition holds"}


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    for message in subject.protocol.messages:
        if message.send_type in _PERIODIC and not message.period:
            text = (
                f"{message.name} is sent periodically, {_PERIODIC[message.send_type]}, but has no "
                f"cycle time: give it, or correct how it is sent"
            )
            yield Found(places.message(message, "period"), message.name, text, message.name)


RULE = Rule(
    "period-given",
    "a message that is sent periodically has its cycle time",
    _check,
    level="warning",
)
