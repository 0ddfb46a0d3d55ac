"""The identifiers of the protocol, and those that are nearly one of them."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.rules.frames.left_over import EXTENDED, KEYS
from typedcan.wire.message import Message

ADDRESS_BITS = 8
"""The lowest bits of an identifier: the source address."""

PRIORITY_SHIFT = 26
"""Below the priority, the highest three bits of an identifier."""

_WITHOUT_PRIORITY = (1 << PRIORITY_SHIFT) - 1

_IDS = {message.FRAME_ID: message for message in PROTOCOL.messages}
_PRIORITY_MASK = np.uint32(EXTENDED | _WITHOUT_PRIORITY)
_REST = KEYS & _PRIORITY_MASK
_HEADS = KEYS >> np.uint32(ADDRESS_BITS)
_ADDRESSES = {
    node: {message.FRAME_ID & 0xFF for message in PROTOCOL.sent_by(node)} for node in PROTOCOL.nodes
}

# What follows takes and gives keys as `LeftOver` has them.


def has_other_priority(keys: NDArray[np.uint32]) -> NDArray[np.bool_]:
    """Which are those of a message but for their priority."""
    return np.isin(keys & _PRIORITY_MASK, _REST) & ~np.isin(keys, KEYS)


def has_other_address(keys: NDArray[np.uint32]) -> NDArray[np.bool_]:
    """Which have priority, PF and PS of a message, but the source address of none such."""
    return np.isin(keys >> np.uint32(ADDRESS_BITS), _HEADS) & ~np.isin(keys, KEYS)


def is_foreign(keys: NDArray[np.uint32]) -> NDArray[np.bool_]:
    """Which are no message's and differ from a message's in more than the priority."""
    return ~np.isin(keys, KEYS) & ~has_other_priority(keys)


def with_head(frame_id: int) -> tuple[type[Message], ...]:
    """The messages with the priority, PF and PS of an identifier, in the standard's order."""
    head = frame_id >> ADDRESS_BITS
    return tuple(each for number, each in _IDS.items() if number >> ADDRESS_BITS == head)


def meant(frame_id: int, seen: Collection[type[Message]]) -> type[Message] | None:
    """Which message a frame with another source address was meant to be, None for none.

    A source address that a node has in its other messages gives that node away. With any other
    the frame is one that the log lacks; where it lacks none, others on the bus sent it, to whom
    group extensions such as those of 0xFF belong as well.

    Parameters
    ----------
    seen
        The messages that came with their own identifier.
    """
    candidates = with_head(frame_id)
    for message in candidates:
        if frame_id & 0xFF in _ADDRESSES[message.SENDER]:
            return message
    return next((message for message in candidates if message not in seen), None)


def written(key: int) -> str:
    """An identifier for people: eight digits where it has 29 bits, else three."""
    return f"0x{key & ~EXTENDED:08X}" if key & EXTENDED else f"0x{key:03X}"
