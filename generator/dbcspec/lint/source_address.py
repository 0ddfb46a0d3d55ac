"""Rule source-address: the last byte of a J1939 identifier is an address of the sender."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.j1939 import addresses, has_addresses, shown
from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.j1939 import NULL_ADDRESS, source_address


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    known = {node.name: addresses(node) for node in subject.protocol.nodes}
    for message in subject.protocol.messages:
        if not has_addresses(message, subject):
            continue
        own, source = known.get(message.sender), source_address(message.frame_id)
        # Files for any sender have the null address in their identifiers.
        if not own or not message.extended or source in own | {NULL_ADDRESS}:
            continue
        others = [name for name, theirs in known.items() if source in theirs]
        hint = f", the address of {others[0]}" if others else ""
        text = (
            f"{message.name} 0x{message.frame_id:X} ends in 0x{source:02X}{hint}, but "
            f"{message.sender}, which sends it, has {shown(own)}: correct one"
        )
        yield Found(places.message(message, "id"), message.name, text, message.name)


RULE = Rule(
    "source-address",
    "a J1939 identifier ends in an address of the sender",
    _check,
    level="warning",
    foreign=True,
)
