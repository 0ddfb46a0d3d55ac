"""Some frames of a log, decoded and sorted by their messages."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.series import Series
from typedcan.logs.frames import FrameBlock
from typedcan.model.seal import Seal
from typedcan.wire.message import Message


class DecodedChunk:
    """Consecutive frames of one log.

    Parameters
    ----------
    block
        All of them, known or not, sound or not; its time stamps are the log's own.
    begin
        Time stamp of the log's first frame: block.timestamp - begin are seconds since then.
    first_order
        Number of the block's first frame in the log, from 0.
    end
        The latest time so far, in seconds since the log's begin.
    seals
        By name of the message, what makes its checksum, where something does.
    others
        int64, rows of messages that are found by their PGN and come from other nodes than those
        that send them by the protocol; None where there are none. They are nobody's to judge.
    """

    def __init__(
        self,
        block: FrameBlock,
        begin: float,
        first_order: int,
        end: float,
        frames: Mapping[type[Message], Series],
        sound: Mapping[type[Message], Series],
        *,
        seals: Mapping[str, Seal],
        others: NDArray[np.int64] | None = None,
    ) -> None:
        self.block = block
        self.begin = begin
        self.first_order = first_order
        self.end = end
        self.by_message = frames
        self.sound_by_message = sound
        self.seals = seals
        self.others = others

    def frames(self, message: type[Message]) -> Series:
        """The frames of a message with the right length, whatever their checksum."""
        return self.by_message[message]

    def sound(self, message: type[Message]) -> Series:
        """Those of them with the right checksum too: those that can be believed."""
        return self.sound_by_message[message]
