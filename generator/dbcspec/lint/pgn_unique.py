"""Rule pgn-unique: no two J1939 messages have one parameter group number.

Tools in J1939 mode look messages up by this number and take the two for one. Not run unasked: that
several nodes send one group, each from its own address, is what J1939 means them to do.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.j1939 import is_j1939
from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.j1939 import pgn


def _check(subject: Subject) -> Iterator[Found]:
    if not is_j1939(subject.protocol):
        return
    places = Places(subject)
    first: dict[int, str] = {}
    identifiers: set[int] = set()
    for message in subject.protocol.messages:
        # That two have the same identifier, identifier-unique says.
        if not message.extended or message.frame_id in identifiers:
            continue
        identifiers.add(message.frame_id)
        group = pgn(message.frame_id)
        other = first.setdefault(group, message.name)
        if other != message.name:
            text = (
                f"{message.name} has the PGN 0x{group:04X} of {other}: tools in J1939 mode "
                f"take them for one; give one another number, or use no such tool"
            )
            yield Found(places.message(message, "id"), message.name, text, message.name)


RULE = Rule(
    "pgn-unique",
    "no two J1939 messages have one parameter group number",
    _check,
    default=False,
    level="note",
)
