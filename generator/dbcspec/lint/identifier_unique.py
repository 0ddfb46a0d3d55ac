"""Rule identifier-unique: every message has an identifier of its own, within 11 or 29 bits."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.protocol import Message

_HIGHEST = {False: (11, 0x7FF), True: (29, 0x1FFF_FFFF)}


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    first: dict[int, Message] = {}
    for message in subject.protocol.messages:
        where = places.message(message, "id")
        width, highest = _HIGHEST[message.extended]
        shown = f"0x{message.frame_id:X}"
        if not 0 <= message.frame_id <= highest:
            text = (
                f"{message.name}: {shown} is no {width}-bit identifier, which ends at "
                f"0x{highest:X}: correct it"
            )
            yield Found(where, message.name, text)
        # Readers look messages up by the number alone, so 11 and 29 bits share one space.
        other = first.setdefault(message.frame_id, message)
        if other is not message:
            text = f"{message.name} has the identifier {shown} of {other.name}: correct one"
            yield Found(where, message.name, text)


RULE = Rule(
    "identifier-unique", "every message has an identifier of its own, of 11 or 29 bits", _check
)
