"""On which channel each message is judged: the one on which it is seen first."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.wire.message import Message

_KIND = np.uint8(FrameFlag.EXTENDED | FrameFlag.FD | FrameFlag.REMOTE | FrameFlag.ERROR)

Rows = NDArray[np.int64] | slice


class Homes:
    """The channels of messages while a log is read; ``channels`` has those known so far by name."""

    def __init__(self) -> None:
        self.channels: dict[str, int | str | None] = {}

    def find(self, message: type[Message], block: FrameBlock, rows: NDArray[np.int64]) -> None:
        """Take these frames of a message, where there are some, for the first ones."""
        if len(rows):
            self.channels.setdefault(message.NAME, block.channels[block.channel[rows[0]]])

    def at_home(
        self, message: type[Message], block: FrameBlock, rows: NDArray[np.int64]
    ) -> NDArray[np.bool_]:
        """Which of these frames are on the channel of their message."""
        home = self.channels.get(message.NAME)
        there = np.array([channel == home for channel in block.channels])
        own: NDArray[np.bool_] = there[block.channel[rows]]
        return own


def is_judged(message: type[Message], block: FrameBlock, rows: Rows) -> NDArray[np.bool_]:
    """Which of these frames are classic data frames, of the right identifier's and own length."""
    kind = FrameFlag.EXTENDED if message.EXTENDED else 0
    good: NDArray[np.bool_] = (block.flags[rows] & _KIND) == np.uint8(kind)
    good &= block.length[rows] == message.LENGTH
    return good
