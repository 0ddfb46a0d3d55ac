"""What a line of a text log holds: a frame, or something else."""

from __future__ import annotations

import math
from dataclasses import dataclass
from datetime import datetime

from typedcan.logs.frames import FrameFlag

LARGEST_ID = 0x1FFFFFFF

# plain numbers: arithmetic with IntFlag is slow
EXTENDED = int(FrameFlag.EXTENDED)
REMOTE = int(FrameFlag.REMOTE)
ERROR = int(FrameFlag.ERROR)
FD = int(FrameFlag.FD)
BIT_RATE_SWITCH = int(FrameFlag.BIT_RATE_SWITCH)
ERROR_STATE = int(FrameFlag.ERROR_STATE)
SENT = int(FrameFlag.SENT)

LENGTHS = (*range(9), 12, 16, 20, 24, 32, 48, 64)
"""Bytes of payload, by DLC."""

_LONGEST = 64


@dataclass(slots=True)
class Frame:
    """A frame, its time as written: see `FrameBlock` for what the fields mean."""

    timestamp: float
    frame_id: int
    flags: int
    channel: int | str | None
    length: int
    data: bytes


@dataclass(slots=True)
class Other:
    """What is no frame on the bus.

    Parameters
    ----------
    kind
        What it is, for people and in the plural; empty: nothing that anybody counts.
    timestamp
        Its time as written, if it has one.
    begins
        From this line on times may count from another moment: that one.
    """

    kind: str
    timestamp: float = math.nan
    begins: datetime | None = None


COMMENT = Other("")
"""What nobody counts."""


def checked(frame: Frame) -> Frame:
    """The frame; raises `ValueError` where no bus has such a one."""
    if not 0 <= frame.frame_id <= LARGEST_ID:
        raise ValueError("the identifier has more than 29 bits")
    if not math.isfinite(frame.timestamp):
        raise ValueError("the time is no number")
    if not 0 <= frame.length <= _LONGEST:
        raise ValueError("no frame has so many bytes")
    if not frame.flags & REMOTE and frame.length != len(frame.data):
        raise ValueError("the length and the payload do not agree")
    if frame.length > 8 and not frame.flags & (FD | REMOTE):
        raise ValueError("no classic frame has so many bytes")
    if isinstance(frame.channel, str) and not frame.channel.isprintable():
        raise ValueError("the channel is no name")
    return frame


def joined_bytes(tokens: list[str], base: int = 16) -> bytes:
    """The bytes that the tokens are, of up to three digits each; raises `ValueError`."""
    if base == 16:
        data = bytes.fromhex("".join(tokens))
        if len(data) != len(tokens) or any(len(token) != 2 for token in tokens):
            raise ValueError("a byte has two digits")
        return data
    return bytes(int(token, base) for token in tokens)
