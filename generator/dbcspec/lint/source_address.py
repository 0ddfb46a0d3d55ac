"""Rule source-address: the last byte of a J1939 identifier is an address of the sender."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.j1939 import NULL_ADDRESS, addresses, shown, source
from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    known = {node.name: addresses(node) for node in subject.protocol.nodes}
    for message in subject.protocol.messages:
        own = known.get(message.sender)
        # Files for any sender have the null address in their identifiers.
        if not own or not message.extended or source(message) in own | {NULL_ADDRESS}:
            continue
        others = [name for name, theirs in known.items() if source(message) in theirs]
        hint = f", the address of {others[0]}" if others else ""
        text = (
            f"{message.name} 0x{message.frame_id:X} ends in 0x{source(message):02X}{hint}, but "
            f"{message.sender}, which sends it, has {shown(own)}: correct one"
        )
        yield Found(places.message(message, "id"), message.name, text, message.name)


RULE = Rule("source-address", "a J1939 identifier ends in an address of the sender", _check)
