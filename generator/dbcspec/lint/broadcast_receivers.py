"""Rule broadcast-receivers: a J1939 message that is sent to all is not declared for one node.

Not run unasked: in most files the receivers are only those nodes that care.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.j1939 import is_j1939
from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.j1939 import is_pdu2


def _check(subject: Subject) -> Iterator[Found]:
    if not is_j1939(subject.protocol):
        return
    places = Places(subject)
    for message in subject.protocol.messages:
        if message.extended and is_pdu2(message.frame_id) and len(message.receivers) == 1:
            text = (
                f"{message.name} 0x{message.frame_id:X} is PDU2, which goes to all, but only "
                f"{message.receivers[0]} is declared to receive it: correct one"
            )
            yield Found(places.message(message, "id"), message.name, text, message.name)


RULE = Rule(
    "broadcast-receivers",
    "a J1939 message that is sent to all (PDU2) is not declared for one node",
    _check,
    default=False,
    level="note",
)
