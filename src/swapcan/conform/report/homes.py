"""On which channel each message is judged: the one on which it is seen first."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from swapcan.logs.columns import MessageColumns
from swapcan.logs.frames import FrameBlock, FrameFlag
from swapcan.message import Message

_KIND = np.uint8(FrameFlag.EXTENDED | FrameFlag.FD | FrameFlag.REMOTE | FrameFlag.ERROR)


class Homes:
    """Finds the channels of some messages while a log is read.

    Parameters
    ----------
    messages
        Whose channels are asked for.
    """

    def __init__(self, messages: Iterable[type[Message]]) -> None:
        self._messages = {message.NAME: message for message in messages}
        self._homes: dict[str, int | str | None] = {}

    def look(self, block: FrameBlock, counts: NDArray[np.bool_]) -> None:
        """Look at the next frames of the log; only those that count are judged."""
        for name, message in self._messages.items():
            if name not in self._homes:
                own = counts & (block.frame_id == message.FRAME_ID) & _good(message, block)
                if own.any():
                    self._homes[name] = block.channels[block.channel[own.argmax()]]

    def own(self, columns: MessageColumns) -> NDArray[np.bool_]:
        """Which frames of a message are on its channel, and have its length."""
        good = _good(self._messages[columns.name], columns.block)[columns.rows]
        home = self._homes.get(columns.name)
        there = np.array([channel == home for channel in columns.block.channels])
        kept: NDArray[np.bool_] = good & there[columns.channel]
        return kept


def _good(message: type[Message], block: FrameBlock) -> NDArray[np.bool_]:
    """The classic data frames of the right length, with 29-bit identifiers."""
    good: NDArray[np.bool_] = (block.flags & _KIND) == np.uint8(FrameFlag.EXTENDED)
    good &= block.length == message.LENGTH
    return good
