"""Rule message-fits-frame: a frame, or a transfer of J1939, can carry the bytes of a message."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.j1939 import LONGEST_TRANSFER
from typedcan.model.protocol import FD_LENGTHS, LONGEST_CLASSIC, Message


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    for message in subject.protocol.messages:
        carrier, most = _carrier(message)
        if message.length > most:
            text = (
                f"{message.name} has {message.length} bytes, but {carrier} has {most} at most: "
                f"correct the length or the frame format"
            )
            yield Found(places.message(message, "length"), message.name, text, message.name)


def _carrier(message: Message) -> tuple[str, int]:
    if message.by_pgn:
        return "a transfer of J1939", LONGEST_TRANSFER
    if message.is_fd:
        return "a frame of CAN FD", FD_LENGTHS[-1]
    return "a frame of classic CAN", LONGEST_CLASSIC


RULE = Rule("message-fits-frame", "a frame can carry the bytes of a message", _check, foreign=True)
