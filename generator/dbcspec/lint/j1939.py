"""Which identifiers and addresses are meant as SAE J1939 has them."""

from __future__ import annotations

from dbcspec.lint.rule import Subject
from typedcan.model.j1939 import NULL_ADDRESS
from typedcan.model.protocol import Message, Node, Protocol


def is_j1939(protocol: Protocol) -> bool:
    """Whether the identifiers are meant so: messages say it, or nodes have addresses."""
    return any(each.by_pgn for each in protocol.messages) or any(map(addresses, protocol.nodes))


def has_addresses(message: Message, subject: Subject) -> bool:
    """Whether an identifier surely has addresses as J1939 puts them.

    A spec says which address a node has. In files they are those of network management too, which
    means other things by them, unless the message itself is said to be of J1939.
    """
    return message.extended and (message.by_pgn or subject.spec is not None)


def addresses(node: Node) -> frozenset[int]:
    """The addresses of a node; the null address, which many tools write for none, is none."""
    given = (node.address, *node.other_addresses)
    return frozenset(each for each in given if each is not None and each < NULL_ADDRESS)


def shown(values: frozenset[int]) -> str:
    """Addresses as people write them."""
    return " or ".join(f"0x{value:02X}" for value in sorted(values))
