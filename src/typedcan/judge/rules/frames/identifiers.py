"""The identifiers of the protocol, and those that are nearly one of them."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.measure.left_over import EXTENDED, keys_of
from typedcan.judge.measure.presence import nodes_of
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

ADDRESS_BITS = 8
"""The lowest bits of an identifier: the source address."""

PRIORITY_SHIFT = 26
"""Below the priority, the highest three bits of an identifier."""

_PROPRIETARY = (0xEF, 0xFF)
"""PDU formats that J1939-21 leaves to everybody: what they carry only the sender knows."""

_WITHOUT_PRIORITY = (1 << PRIORITY_SHIFT) - 1
_PRIORITY_MASK = np.uint32(EXTENDED | _WITHOUT_PRIORITY)


class Identifiers:
    """Those of a protocol; what takes keys takes them as `LeftOver` has them."""

    def __init__(self, protocol: Protocol) -> None:
        messages = keys_of(protocol)
        self._keys = np.fromiter(messages, np.uint32)
        # What is found by its PGN may come from any address, with any priority.
        whole = {
            key: each for key, each in messages.items() if key & EXTENDED and not each.MODEL.by_pgn
        }
        extended = np.fromiter(whole, np.uint32)
        self._rest = extended & _PRIORITY_MASK
        self._heads = extended >> np.uint32(ADDRESS_BITS)
        self._extended = tuple(whole.values())
        self._addresses = {
            node: {each.FRAME_ID & 0xFF for each in protocol.messages if node == each.SENDER}
            for node in nodes_of(protocol)
        }
        self._taken = set().union(
            *self._addresses.values(),
            *({each.address, *each.other_addresses} for each in protocol.model.nodes),
        )

    def has_other_priority(self, keys: NDArray[np.uint32]) -> NDArray[np.bool_]:
        """Which are those of a message but for their priority."""
        return np.isin(keys & _PRIORITY_MASK, self._rest) & ~np.isin(keys, self._keys)

    def has_other_address(self, keys: NDArray[np.uint32]) -> NDArray[np.bool_]:
        """Which have priority, PF and PS of a message, but the source address of none such."""
        heads = keys >> np.uint32(ADDRESS_BITS)
        return np.isin(heads, self._heads) & ~np.isin(keys, self._keys)

    def is_foreign(self, keys: NDArray[np.uint32]) -> NDArray[np.bool_]:
        """Which are no message's and differ from a message's in more than the priority."""
        return ~np.isin(keys, self._keys) & ~self.has_other_priority(keys)

    def with_head(self, frame_id: int) -> tuple[type[Message], ...]:
        """The messages with the priority, PF and PS of an identifier, in the protocol's order."""
        head = frame_id >> ADDRESS_BITS
        return tuple(each for each in self._extended if head == each.FRAME_ID >> ADDRESS_BITS)

    def meant(self, frame_id: int, seen: Collection[type[Message]]) -> type[Message] | None:
        """Which message a frame with another source address was meant to be, None for none.

        A source address that a node has in its other messages gives that node away. A proprietary
        PGN from an address that no node has is somebody else's: it is theirs as well. With any
        other the frame is one that the log lacks; where it lacks none, others on the bus sent it.

        Parameters
        ----------
        seen
            The messages that came with their own identifier.
        """
        candidates = self.with_head(frame_id)
        for message in candidates:
            if frame_id & 0xFF in self._addresses[message.SENDER]:
                return message
        if frame_id >> 16 & 0xFF in _PROPRIETARY and frame_id & 0xFF not in self._taken:
            return None
        return next((message for message in candidates if message not in seen), None)


def written(key: int) -> str:
    """An identifier for people: eight digits where it has 29 bits, else three."""
    return f"0x{key & ~EXTENDED:08X}" if key & EXTENDED else f"0x{key:03X}"
