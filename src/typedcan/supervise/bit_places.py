"""Where the bits of each signal stand in the payload, seen as one number."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Literal, NamedTuple

from typedcan.wire.database import Entry, database
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


def byte_order(protocol: Protocol, message: type[Message]) -> ByteOrder:
    """The order of bytes in which the payload of a message is seen as a number."""
    return database(protocol).by_type[message].packer.byte_order


@cache
def bit_places(protocol: Protocol) -> Mapping[type[Message], Mapping[str, Place]]:
    """Where the signals of each message stand, by their names."""
    return {message: _places(entry) for message, entry in database(protocol).by_type.items()}


def numbering(protocol: Protocol, transfer: Transfer) -> int:
    """The bits that tell the frames of a transfer apart."""
    refs = (transfer.group, transfer.frame_number)
    masks = (bit_places(protocol)[ref.message][ref.field].mask for ref in refs if ref)
    return sum(masks)


def _places(entry: Entry) -> dict[str, Place]:
    """What each bit of the payload does to the raw values, found by unpacking it alone."""
    length = entry.type.LENGTH
    masks = dict.fromkeys(entry.type.FIELDS, 0)
    shifts: dict[str, set[int]] = {name: set() for name in masks}
    for bit in range(length * 8):
        raws = entry.packer.unpack((1 << bit).to_bytes(length, entry.packer.byte_order))
        for name, raw in zip(masks, raws, strict=True):
            if raw:
                masks[name] |= 1 << bit
                shifts[name].add(bit + 1 - raw.bit_length())
    return {
        name: Place(mask, shifts[name].pop() if len(shifts[name]) == 1 else None)
        for name, mask in masks.items()
    }
