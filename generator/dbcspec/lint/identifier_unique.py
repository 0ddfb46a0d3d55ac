"""Rule identifier-unique: every message has an identifier of its own, within 11 or 29 bits."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.protocol import Message

_HIGHEST = {False: (11, 0x7FF), True: (29, 0x1FFF_FFFF)}


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    first: dict[tuple[int, bool], Message] = {}
    for message in subject.protocol.messages:
        where = places.message(message, "id")
        width, highest = _HIGHEST[message.extended]
        shown = f"0x{message.frame_id:X}"
        if not 0 <= message.frame_id <= highest:
            sure = subject.dbc_text is None or message.extended
            remedy = "correct it" if sure else "add 2147483648, which marks one of 29 bits"
            text = (
                f"{message.name}: {shown} is no {width}-bit identifier, which ends at "
                f"0x{highest:X}: {remedy}"
            )
            yield Found(where, message.name, text)
        # Some readers look messages up by the number alone: for them 11 and 29 bits share a space.
        width_counts = message.extended and not subject.settings.house
        other = first.setdefault((message.frame_id, width_counts), message)
        if other is not message:
            text = f"{message.name} has the identifier {shown} of {other.name}: correct one"
            yield Found(where, message.name, text)


RULE = Rule(
    "identifier-unique",
    "every message has an identifier of its own, of 11 or 29 bits",
    _check,
    foreign=True,
)
