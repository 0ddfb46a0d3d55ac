"""Where the frames of a batch of lines are put, a row per line."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.frames import FrameBlock
from typedcan.logs.read.blocks import NARROW, WIDE
from typedcan.logs.read.frame import Frame
from typedcan.logs.read.shape import Values


class Columns:
    """The frames of ``size`` lines; a row that is not ``filled`` is no frame."""

    def __init__(self, size: int) -> None:
        self.timestamp = np.zeros(size, np.float64)
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

    def put_alike(self, rows: NDArray[np.int64], frame: Frame, channel: int) -> None:
        """What the lines of a shape share with one that was read; ``channel`` is its index."""
        self.flags[rows] = frame.flags
        self.channel[rows] = channel
        self.length[rows] = frame.length
        self.filled[rows] = True

    def put_frames(self, frames: list[tuple[int, Frame, int]]) -> None:
        """Single frames, each with its row before it and the index of its channel behind it."""
        if not frames:
            return
        rows = np.array([row for row, _, _ in frames])
        self.timestamp[rows] = [frame.timestamp for _, frame, _ in frames]
        self.frame_id[rows] = [frame.frame_id for _, frame, _ in frames]
        self.flags[rows] = [frame.flags for _, frame, _ in frames]
        self.channel[rows] = [channel for _, _, channel in frames]
        self.length[rows] = [frame.length for _, frame, _ in frames]
        self.filled[rows] = True
        longest = max(len(frame.data) for _, frame, _ in frames)
        width = WIDE if longest > NARROW else NARROW
        data = b"".join([frame.data.ljust(width, b"\0") for _, frame, _ in frames])
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
