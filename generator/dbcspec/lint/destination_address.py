"""Rule destination-address: a J1939 message to one address is received by the node that has it."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.j1939 import addresses, has_addresses, shown
from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.j1939 import GLOBAL_ADDRESS, NULL_ADDRESS, destination


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    known = {node.name: addresses(node) for node in subject.protocol.nodes}
    for message in subject.protocol.messages:
        if not has_addresses(message, subject):
            continue
        heard_at = frozenset[int]().union(*(known.get(each, ()) for each in message.receivers))
        address = destination(message.frame_id)
        # Files for any receiver have the null address in their identifiers.
        if address in (GLOBAL_ADDRESS, NULL_ADDRESS):
            continue
        if not heard_at or not message.extended or address in heard_at:
            continue
        text = (
            f"{message.name} 0x{message.frame_id:X} goes to 0x{address:02X}, but "
            f"{', '.join(message.receivers)}, which receives it, has {shown(heard_at)}: correct one"
        )
        yield Found(places.message(message, "id"), message.name, text, message.name)


RULE = Rule(
    "destination-address",
    "a J1939 message to one address is received by who has it",
    _check,
    level="warning",
    foreign=True,
)
