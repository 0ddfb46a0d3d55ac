"""Frames as columns: what the log readers make and the vectorised decoder takes."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntFlag

import numpy as np
from numpy.typing import NDArray


class FrameFlag(IntFlag):
    """Bits of `FrameBlock.flags`."""

    EXTENDED = 1
    REMOTE = 2
    ERROR = 4
    FD = 8
    BIT_RATE_SWITCH = 16
    ERROR_STATE = 32
    SENT = 64
    """Not received: is_rx is False."""


@dataclass(frozen=True, slots=True)
class FrameBlock:
    """Some frames of a log, in its order, a column per property; all arrays have n rows.

    Parameters
    ----------
    timestamp
        float64, seconds, as python-can gives them for the same file.
    frame_id
        uint32, the bare identifier (no flag bits).
    flags
        uint8, `FrameFlag`.
    channel
        int16, index into ``channels``.
    length
        uint8, bytes of payload (for a remote frame its DLC).
    data
        uint8, shape (n, 8) or (n, 64), zero beyond ``length``; rows are contiguous.
    channels
        What python-can gives as ``Message.channel``, by index.
    """

    timestamp: NDArray[np.float64]
    frame_id: NDArray[np.uint32]
    flags: NDArray[np.uint8]
    channel: NDArray[np.int16]
    length: NDArray[np.uint8]
    data: NDArray[np.uint8]
    channels: tuple[int | str | None, ...]

    def __len__(self) -> int:
        """How many frames."""
        return len(self.timestamp)
