"""Which frames of a message are judged: those of its format, on the channel where it came first."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.model.j1939 import own_addresses
from typedcan.model.protocol import Aspect
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_FORMAT = np.uint8(FrameFlag.EXTENDED | FrameFlag.FD | FrameFlag.REMOTE | FrameFlag.ERROR)

Rows = NDArray[np.int64] | slice


class Channels:
    """The channels of messages while a log is read; ``first`` has those known so far by name."""

    def __init__(self) -> None:
        self.first: dict[str, int | str | None] = {}

    def note(self, message: type[Message], block: FrameBlock, rows: NDArray[np.int64]) -> None:
        """Take these frames of a message, where there are some, for the first ones."""
        if len(rows):
            self.first.setdefault(message.NAME, block.channels[block.channel[rows[0]]])

    def are_first(
        self, message: type[Message], block: FrameBlock, rows: NDArray[np.int64]
    ) -> NDArray[np.bool_]:
        """Which of these frames are on the channel where their message came first."""
        first = self.first.get(message.NAME)
        there = np.array([channel == first for channel in block.channels])
        own: NDArray[np.bool_] = there[block.channel[rows]]
        return own


class Senders:
    """Whose frames of a message are judged that is found by its PGN: those of its sender.

    Where nobody says which address that has, they are those of who sends it first.
    """

    def __init__(self, protocol: Protocol) -> None:
        self._addresses = {
            message.NAME: own_addresses(protocol.model, message.MODEL)
            for message in protocol.messages
        }

    def sent(self, message: type[Message], frame_id: NDArray[np.uint32]) -> NDArray[np.bool_]:
        """Which of these identifiers, some at least, have an address of the sender."""
        sources = (frame_id & np.uint32(0xFF)).astype(np.int64)
        if not self._addresses[message.NAME]:
            self._addresses[message.NAME] = frozenset((int(sources[0]),))
        return np.isin(sources, sorted(self._addresses[message.NAME]))


class Formats:
    """Which frames have the format of their message: its identifier's width, and CAN FD or not.

    Where nothing is known of CAN FD, as in a database that says nothing of it, either will do.
    """

    def __init__(self, protocol: Protocol) -> None:
        known = Aspect.FRAME_FORMATS in protocol.model.carries
        self._looked_at = _FORMAT if known else _FORMAT & ~np.uint8(FrameFlag.FD)

    def fit(self, message: type[Message], block: FrameBlock, rows: Rows) -> NDArray[np.bool_]:
        """Which of these frames have that of a message."""
        flags = FrameFlag.EXTENDED if message.EXTENDED else FrameFlag(0)
        if message.MODEL.is_fd:
            flags |= FrameFlag.FD
        due = np.uint8(flags) & self._looked_at
        good: NDArray[np.bool_] = (block.flags[rows] & self._looked_at) == due
        return good


def has_length(message: type[Message], block: FrameBlock, rows: Rows) -> NDArray[np.bool_]:
    """Which of these frames have the bytes of a message; CAN FD fills them up where it has to."""
    good: NDArray[np.bool_] = block.length[rows] == message.LENGTH
    if message.MODEL.frame_length != message.LENGTH:
        good |= block.length[rows] == message.MODEL.frame_length
    return good
