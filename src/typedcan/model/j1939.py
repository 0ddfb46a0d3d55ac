"""How SAE J1939 reads a 29-bit identifier, and which message a frame is by its PGN."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Generic, TypeVar

from typedcan.model.protocol import LONGEST_CLASSIC, Message, Protocol

GLOBAL_ADDRESS = 0xFF
"""The destination of what is sent to all."""

NULL_ADDRESS = 0xFE
"""Of a node that has no address; in databases that of whichever node it is."""

LONGEST_TRANSFER = 1785
"""Bytes that the transport protocol carries."""

_FIRST_PDU2 = 240
_PDU1_DESTINATION = 0xFF00

T = TypeVar("T")


def is_pdu2(frame_id: int) -> bool:
    """Whether it is sent to all; else its third byte is the address of the receiver."""
    return frame_id >> 16 & 0xFF >= _FIRST_PDU2


def pgn(frame_id: int) -> int:
    """The parameter group number: without the destination where there is one."""
    group = frame_id >> 8 & 0x3FFFF
    return group if is_pdu2(frame_id) else group & 0x3FF00


def priority(frame_id: int) -> int:
    """The priority, 0 the highest and 7 the lowest."""
    return frame_id >> 26 & 7


def source_address(frame_id: int) -> int:
    """The address of the sender."""
    return frame_id & 0xFF


def destination(frame_id: int) -> int:
    """The address of the receiver; 255 where it is sent to all."""
    return GLOBAL_ADDRESS if is_pdu2(frame_id) else frame_id >> 8 & 0xFF


def needs_several_frames(message: Message) -> bool:
    """Whether a message takes several frames, by the transport protocol, and no single one."""
    return message.by_pgn and message.length > LONGEST_CLASSIC


def address_in(protocol: Protocol, name: str) -> int:
    """The address of a node of that name; the null address where it has none that is one."""
    known = (node.address for node in protocol.nodes if node.name == name)
    address = next(known, None)
    return address if address is not None and 0 <= address < NULL_ADDRESS else NULL_ADDRESS


def own_addresses(protocol: Protocol, message: Message) -> frozenset[int]:
    """The source addresses of a message's sender, as far as they are known."""
    nodes = [node for node in protocol.nodes if node.name in message.senders]
    known = [each for node in nodes for each in (node.address, *node.other_addresses)]
    given = (*known, source_address(message.frame_id))
    return frozenset(each for each in given if each is not None and each < NULL_ADDRESS)


def sent_identifier(message: Message, source: int, receiver: int | None = None) -> int:
    """The identifier that a message is sent with.

    It is that of the database. Of a message that is matched by its PGN the null address as source
    stands for the sender's, ``source``, and the null address as destination for ``receiver``, else
    for all; a ``receiver`` that is given counts in any case. Raises `ValueError` for what is no
    address.
    """
    number = message.frame_id
    for address in (source, receiver):
        if address is not None and not 0 <= address <= GLOBAL_ADDRESS:
            raise ValueError(f"{address} is no address of J1939: they are 0 to {GLOBAL_ADDRESS}")
    if not message.by_pgn:
        return number
    if source_address(number) == NULL_ADDRESS:
        number = number & ~0xFF | source
    if not is_pdu2(number) and (receiver is not None or destination(number) == NULL_ADDRESS):
        receiver = GLOBAL_ADDRESS if receiver is None else receiver
        number = number & ~_PDU1_DESTINATION | receiver << 8
    return number


class ByPgn(Generic[T]):
    """Finds what belongs to the message that a 29-bit identifier is of, by its PGN.

    Of several messages with one PGN, that with the same source address is meant, else the one with
    the null address, else the first. What has the whole identifier is to be looked for before.
    """

    def __init__(self, messages: Iterable[tuple[Message, T]]) -> None:
        matched = [(each.frame_id, found) for each, found in messages if each.by_pgn]
        # What is found first stays.
        matched.sort(key=lambda pair: source_address(pair[0]) != NULL_ADDRESS)
        self._by_source: dict[tuple[int, int], T] = {}
        self._by_pgn: dict[int, T] = {}
        for number, found in matched:
            self._by_source.setdefault((pgn(number), source_address(number)), found)
            self._by_pgn.setdefault(pgn(number), found)

    def __bool__(self) -> bool:
        """Whether any message is matched so."""
        return bool(self._by_pgn)

    def find(self, frame_id: int) -> T | None:
        """What belongs to a 29-bit identifier; None where no message has its PGN."""
        group = pgn(frame_id)
        found = self._by_source.get((group, source_address(frame_id)))
        return self._by_pgn.get(group) if found is None else found
