"""Rule comment-given: every message and every signal has a comment or title.

Where none at all has one, this is one finding of the whole protocol.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.protocol import NOWHERE, Message, Signal


def _check(subject: Subject) -> Iterator[Found]:
    protocol = subject.protocol
    parts: list[Message | Signal] = [*protocol.messages, *(each for _, each in protocol.signals())]
    if not any(map(_is_described, parts)):
        if protocol.messages:
            text = "no message and no signal has a comment: say what they carry"
            yield Found(NOWHERE, protocol.name, text)
        return
    places = Places(subject)
    for message in protocol.messages:
        if not _is_described(message):
            text = f"{message.name} has no comment: say what it carries"
            yield Found(places.message(message, "english"), message.name, text, message.name)
        for signal in message.signals:
            if not _is_described(signal):
                text = f"{signal.name} of {message.name} has no comment: say what it means"
                yield Found(places.meaning(signal, "english"), signal.name, text, message.name)


def _is_described(part: Message | Signal) -> bool:
    return bool(part.english or part.title)


RULE = Rule(
    "comment-given", "every message and every signal has a comment", _check, level="warning"
)
