"""Pieces of a log, of any size, become blocks of one size; channels become indices."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.frames import FrameBlock

NARROW, WIDE = 8, 64
"""Bytes in a row of ``FrameBlock.data``."""

MAX_CHANNELS = 2**15
"""`FrameBlock.channel` is an int16."""

_BEYOND = np.arange(WIDE) >= np.arange(WIDE + 1)[:, np.newaxis]


class Channels:
    """The channels of a log, numbered as they appear."""

    def __init__(self) -> None:
        self._index: dict[int | str | None, int] = {}

    @property
    def known(self) -> tuple[int | str | None, ...]:
        """All channels so far, by number."""
        return tuple(self._index)

    def index(self, channel: int | str | None) -> int:
        """The number of one channel.

        Raises `ValueError` where a damaged file has more of them than any bus.
        """
        number = self._index.get(channel)
        if number is None:
            number = len(self._index)
            if number == MAX_CHANNELS:
                raise ValueError(f"more than {MAX_CHANNELS:,} channels")
            self._index[channel] = number
        return number

    def indices(self, channels: NDArray[np.int32]) -> NDArray[np.int16]:
        """The numbers of numbered channels; raises as `index` does."""
        if len(channels) and (channels == channels[0]).all():
            return np.full(len(channels), self.index(int(channels[0])), np.int16)
        values, first, inverse = np.unique(channels, return_index=True, return_inverse=True)
        for place in np.sort(first):
            self.index(int(channels[place]))
        numbers = np.array([self.index(int(value)) for value in values], np.int16)
        return numbers[inverse]


def clear_beyond(data: NDArray[np.uint8], length: NDArray[np.uint8]) -> None:
    """Set the bytes of each row that are no payload to zero, in place."""
    if (length != data.shape[1]).any():
        data[_BEYOND[length, : data.shape[1]]] = 0


def reblock(pieces: Iterable[FrameBlock], size: int) -> Iterator[FrameBlock]:
    """The same frames in blocks of ``size``; the last one may be shorter."""
    waiting: list[FrameBlock] = []
    count = 0
    for whole in pieces:
        piece = whole
        while count + len(piece) >= size:
            room = size - count
            yield joined([*waiting, rows_of(piece, slice(0, room))])
            piece = rows_of(piece, slice(room, None))
            waiting, count = [], 0
        if len(piece):
            waiting.append(piece)
            count += len(piece)
    if waiting:
        yield joined(waiting)


def rows_of(block: FrameBlock, rows: slice | NDArray[np.int64]) -> FrameBlock:
    """Some rows of a block; slices are views."""
    return FrameBlock(
        block.timestamp[rows],
        block.frame_id[rows],
        block.flags[rows],
        block.channel[rows],
        block.length[rows],
        block.data[rows],
        block.channels,
    )


def joined(blocks: list[FrameBlock]) -> FrameBlock:
    """One block of blocks of one log."""
    if len(blocks) == 1:
        return blocks[0]
    return FrameBlock(
        np.concatenate([block.timestamp for block in blocks]),
        np.concatenate([block.frame_id for block in blocks]),
        np.concatenate([block.flags for block in blocks]),
        np.concatenate([block.channel for block in blocks]),
        np.concatenate([block.length for block in blocks]),
        _joined_data(blocks),
        max((block.channels for block in blocks), key=len),  # each begins as the others do
    )


def _joined_data(blocks: list[FrameBlock]) -> NDArray[np.uint8]:
    width = max(block.data.shape[1] for block in blocks)
    data = np.zeros((sum(map(len, blocks)), width), np.uint8)
    start = 0
    for block in blocks:
        data[start : start + len(block), : block.data.shape[1]] = block.data
        start += len(block)
    return data
