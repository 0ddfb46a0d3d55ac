"""Where the bits of each signal stand in the payload, seen as one number."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from itertools import pairwise
from typing import Literal, NamedTuple

from typedcan.model import layout
from typedcan.model import protocol as model
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol, Transfer

ByteOrder = Literal["big", "little"]


class Place(NamedTuple):
    """The bits of a signal in the number.

    They make its raw value once they are shifted right by ``shift``; None where that is not so,
    as its bytes are in another order than those of the number.
    """

    mask: int
    shift: int | None


def byte_order(message: type[Message]) -> ByteOrder:
    """The order of bytes in which the payload of a message is seen as a number.

    Little where both orders are mixed.
    """
    orders = {signal.byte_order for signal in message.MODEL.signals}
    return "big" if orders == {model.ByteOrder.MOTOROLA} else "little"


@cache
def bit_places(protocol: Protocol) -> Mapping[type[Message], Mapping[str, Place]]:
    """Where the signals of each message stand, by their names."""
    return {message: _places(message) for message in protocol.messages}


def numbering(protocol: Protocol, transfer: Transfer) -> int:
    """The bits that tell the frames of a transfer apart."""
    refs = (transfer.group, transfer.frame_number)
    masks = (bit_places(protocol)[ref.message][ref.field].mask for ref in refs if ref)
    return sum(masks)


def _places(message: type[Message]) -> dict[str, Place]:
    order, length = byte_order(message), message.LENGTH
    places: dict[str, Place] = {}
    for field in message.FIELDS.values():
        bits = [
            bit if order == "little" else bit + 8 * (length - 1 - 2 * (bit // 8))
            for bit in layout.bits(field.signal)
        ]
        in_order = all(after == before + 1 for before, after in pairwise(bits))
        places[field.name] = Place(sum(1 << bit for bit in bits), bits[0] if in_order else None)
    return places
