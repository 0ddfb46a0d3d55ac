"""Where the frames of a batch of lines are put, a row per line."""

from __future__ import annotations

import math

import can
import numpy as np
from can.util import dlc2len
from numpy.typing import NDArray

from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.logs.read.blocks import NARROW, WIDE
from typedcan.logs.read.shape import Values

_LARGEST_ID = 0x1FFFFFFF

# plain numbers: arithmetic with IntFlag is slow
_EXTENDED = int(FrameFlag.EXTENDED)
_REMOTE = int(FrameFlag.REMOTE)
_ERROR = int(FrameFlag.ERROR)
_FD = int(FrameFlag.FD)
_BIT_RATE_SWITCH = int(FrameFlag.BIT_RATE_SWITCH)
_ERROR_STATE = int(FrameFlag.ERROR_STATE)
_SENT = int(FrameFlag.SENT)


def payload_length(frame: can.Message) -> int:
    """The bytes of payload of a frame, or the DLC of a remote frame.

    Raises `ValueError` where python-can made a frame of a line that does not hold one.
    """
    if not 0 <= frame.arbitration_id <= _LARGEST_ID:
        raise ValueError("the identifier has more than 29 bits")
    if not math.isfinite(frame.timestamp):
        raise ValueError("the time is no number")
    length = frame.dlc if frame.is_remote_frame else len(frame.data)
    meant = frame.dlc
    if length != meant and not frame.is_fd:
        meant = min(meant, NARROW)  # a DLC above 8 stands for 8 bytes
    if not 0 <= length <= WIDE or length not in (meant, dlc2len(max(frame.dlc, 0))):
        raise ValueError("the length and the payload do not agree")
    return length


def channel_of(frame: can.Message) -> int | str | None:
    """The channel of a frame.

    Raises `ValueError` where it is garbage.
    """
    channel = frame.channel
    if channel is None or isinstance(channel, int):
        return channel
    if isinstance(channel, str) and channel.isprintable():
        return channel
    raise ValueError("the channel is no name")


def flags_of(frame: can.Message) -> int:
    """The `FrameFlag` bits of a frame."""
    return (
        _EXTENDED * frame.is_extended_id
        | _REMOTE * frame.is_remote_frame
        | _ERROR * frame.is_error_frame
        | _FD * frame.is_fd
        | _BIT_RATE_SWITCH * frame.bitrate_switch
        | _ERROR_STATE * frame.error_state_indicator
        | _SENT * (not frame.is_rx)
    )


class Columns:
    """The frames of ``size`` lines; a row that is not ``filled`` is no frame."""

    def __init__(self, size: int) -> None:
        self.timestamp = np.empty(size, np.float64)
        self.frame_id = np.empty(size, np.uint32)
        self.flags = np.empty(size, np.uint8)
        self.channel = np.empty(size, np.int16)
        self.length = np.empty(size, np.uint8)
        self.data = np.zeros((size, NARROW), np.uint8)
        self.filled = np.zeros(size, np.bool_)

    def put(self, rows: NDArray[np.int64], values: Values) -> None:
        """What the lines of a shape do not share."""
        self.timestamp[rows] = values.timestamp
        self.frame_id[rows] = values.frame_id
        self._put_data(rows, values.data)

    def put_alike(
        self, rows: NDArray[np.int64], frame: can.Message, channel: int, length: int
    ) -> None:
        """What the lines of a shape share with one that was read; ``channel`` is its index."""
        self.flags[rows] = flags_of(frame)
        self.channel[rows] = channel
        self.length[rows] = length
        self.filled[rows] = True

    def put_frames(self, frames: list[tuple[int, can.Message, int]]) -> None:
        """Single frames, each with its row before it and the index of its channel behind it."""
        if not frames:
            return
        rows = np.array([row for row, _, _ in frames])
        self.timestamp[rows] = [frame.timestamp for _, frame, _ in frames]
        self.frame_id[rows] = [frame.arbitration_id for _, frame, _ in frames]
        self.flags[rows] = [flags_of(frame) for _, frame, _ in frames]
        self.channel[rows] = [channel for _, _, channel in frames]
        self.length[rows] = [
            frame.dlc if frame.is_remote_frame else len(frame.data) for _, frame, _ in frames
        ]
        self.filled[rows] = True
        longest = max(len(frame.data) for _, frame, _ in frames)
        width = WIDE if longest > NARROW else NARROW
        data = b"".join(bytes(frame.data).ljust(width, b"\0") for _, frame, _ in frames)
        self._put_data(rows, np.frombuffer(data, np.uint8).reshape(-1, width))

    def block(self, channels: tuple[int | str | None, ...]) -> FrameBlock:
        """The rows that are frames."""
        rows = slice(None) if self.filled.all() else self.filled
        return FrameBlock(
            self.timestamp[rows],
            self.frame_id[rows],
            self.flags[rows],
            self.channel[rows],
            self.length[rows],
            self.data[rows],
            channels,
        )

    def _put_data(self, rows: NDArray[np.int64], data: NDArray[np.uint8]) -> None:
        if data.shape[1] > self.data.shape[1]:
            narrow, self.data = self.data, np.zeros((len(self.data), WIDE), np.uint8)
            self.data[:, :NARROW] = narrow
        if self.data.shape[1] == NARROW:
            self.data.view(np.uint64)[rows] = data.view(np.uint64)
        else:
            self.data[rows, : data.shape[1]] = data
