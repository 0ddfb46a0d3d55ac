"""MF4 bus logging, through asammdf: the frames of all channel groups, ordered by their times."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.frames import FrameBlock
from typedcan.logs.read.blocks import Channels, joined, reblock, rows_of
from typedcan.logs.read.mf4_groups import DamagedMf4, Group, Mf4File
from typedcan.logs.read.source import BLOCK_SIZE, Damage, LogSource

_CHUNK_BYTES = 2**24
"""What is held at a time, of all groups together."""

_FRAME_BYTES = 100  # what the columns have for one frame, if it has 64 bytes of payload
_LEAST_CHUNK = 256
"""Records that are read together at least."""


class Mf4Source(LogSource):
    """An MF4 log, as python-can reads it.

    Where a group's records are damaged, those of the other groups are still delivered.

    Parameters
    ----------
    path
        The log.
    block_size
        Frames in a block.

    Raises
    ------
    OSError
        Where the file cannot be opened.
    LogError
        Where asammdf is not installed.
    """

    def __init__(self, path: Path, block_size: int = BLOCK_SIZE) -> None:
        self.path = path
        self.damage: Damage | None = None
        self._block_size = block_size
        self._size = path.stat().st_size
        self._share = 0.0
        self._file: Mf4File | None = None
        path.open("rb").close()
        try:
            self._file = Mf4File(path)
            self.start = self._file.start
        except DamagedMf4 as error:
            self._nothing(error)

    @property
    def size(self) -> int:
        """Bytes of the file."""
        return self._size

    @property
    def position(self) -> int:
        """Bytes of the file that have been read so far, by the share of the frames."""
        return int(self._size * self._share)

    def close(self) -> None:
        """Close the file."""
        if self._file is not None:
            self._file.close()
            self._file = None

    def __iter__(self) -> Iterator[FrameBlock]:
        """The frames, in blocks."""
        return reblock(self._frames(), self._block_size)

    def _frames(self) -> Iterator[FrameBlock]:
        if self._file is None:
            return
        try:
            groups = self._file.groups()
        except DamagedMf4 as error:
            self._nothing(error)
            return
        channels = Channels()
        share = _CHUNK_BYTES // max(len(groups), 1)
        records = [Records(self._file, group, channels, share) for group in groups]
        total, done = sum(group.count for group in groups), 0
        for block in merged(records):
            done += len(block)
            self._share = done / total
            yield block
        self._share = 1.0
        self._broken_groups([each for each in records if each.problem])

    def _nothing(self, error: DamagedMf4) -> None:
        lost = f"{self._size:,} bytes"
        self.damage = Damage(self.path, "byte 0", f"asammdf cannot open it: {error}", lost)

    def _broken_groups(self, broken: list[Records]) -> None:
        if broken:
            first = broken[0]
            where = f"record {first.read} of channel group {first.group.index}"
            lost = f"{sum(each.group.count - each.read for each in broken):,} frames"
            self.damage = Damage(self.path, where, first.problem, lost)


class Records:
    """The records of a group, read in chunks.

    ``read`` is how many were read so far, ``problem`` what ended the reading too early, and
    ``keys`` are what the records that wait are ordered by: the latest time up to each.
    """

    def __init__(self, file: Mf4File, group: Group, channels: Channels, share: int) -> None:
        self.group = group
        self.read = 0
        self.problem = ""
        self.keys: NDArray[np.float64] = np.empty(0)
        self._file = file
        self._channels = channels
        self._chunk = max(share // (group.record_size + _FRAME_BYTES), _LEAST_CHUNK)
        self._waiting: list[FrameBlock] = []
        self._latest = -np.inf

    @property
    def more(self) -> bool:
        """Whether records are still to be read."""
        return self.read < self.group.count and not self.problem

    def fill(self) -> None:
        """Read the next chunk if no record waits."""
        while self.more and not len(self.keys):
            count = min(self._chunk, self.group.count - self.read)
            try:
                block = self._file.frames(self.group, self.read, count, self._channels)
            except DamagedMf4 as error:
                if count == 1:
                    self.problem = str(error)
                self._chunk = max(count // 2, 1)  # what is before the damage may still be read
                continue
            if len(block) < count:
                self.problem = "the records end too early"
            self._add(block)

    def _add(self, block: FrameBlock) -> None:
        times = np.where(np.isnan(block.timestamp), self._latest, block.timestamp)
        self.keys = np.maximum.accumulate(np.maximum(times, self._latest))
        self._waiting = [block]
        self.read += len(block)
        if len(block):
            self._latest = float(self.keys[-1])

    def take(self, count: int) -> tuple[FrameBlock, NDArray[np.float64]]:
        """The first of the waiting records, at least one, and their keys."""
        block, keys = self._waiting[0], self.keys
        self._waiting = [rows_of(block, slice(count, None))]
        self.keys = keys[count:]
        return rows_of(block, slice(0, count)), keys[:count]


def merged(groups: list[Records]) -> Iterator[FrameBlock]:
    """The frames of all groups by time, of equal times the ones of the first group first."""
    while True:
        for group in groups:
            group.fill()
        last = min(
            ((group.keys[-1], place) for place, group in enumerate(groups) if group.more),
            default=(np.inf, len(groups)),
        )
        parts = []
        for place, group in enumerate(groups):
            ready = np.searchsorted(group.keys, last[0], "right" if place <= last[1] else "left")
            if ready:
                parts.append(group.take(int(ready)))
        if not parts:
            return
        blocks = [block for block, _ in parts]
        if len(parts) == 1:
            yield blocks[0]
        else:
            order = np.argsort(np.concatenate([keys for _, keys in parts]), kind="stable")
            yield rows_of(joined(blocks), order)
