"""How SAE J1939 reads a 29-bit identifier."""

from __future__ import annotations

from typedcan.model.protocol import Message, Node, Protocol

GLOBAL_ADDRESS = 255
NULL_ADDRESS = 254
_FIRST_PDU2 = 240


def is_j1939(protocol: Protocol) -> bool:
    """Whether the identifiers are meant so: the frames say it, or nodes have addresses."""
    return protocol.frame_format == "J1939PG" or any(map(addresses, protocol.nodes))


def addresses(node: Node) -> frozenset[int]:
    """The addresses of a node; the null address, which many tools write for none, is none."""
    given = (node.address, *node.other_addresses)
    return frozenset(each for each in given if each is not None and each < NULL_ADDRESS)


def is_pdu2(message: Message) -> bool:
    """Whether it is broadcast; else its third byte is the address of the receiver."""
    return message.frame_id >> 16 & 0xFF >= _FIRST_PDU2


def pgn(message: Message) -> int:
    """The parameter group number: without the destination where the message has one."""
    group = message.frame_id >> 8 & 0x3FFFF
    return group if is_pdu2(message) else group & 0x3FF00


def source(message: Message) -> int:
    """The source address."""
    return message.frame_id & 0xFF


def destination(message: Message) -> int:
    """The destination address; 255 where it is sent to all."""
    return GLOBAL_ADDRESS if is_pdu2(message) else message.frame_id >> 8 & 0xFF


def shown(values: frozenset[int]) -> str:
    """Addresses as people write them."""
    return " or ".join(f"0x{value:02X}" for value in sorted(values))
