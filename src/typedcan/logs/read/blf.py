"""BLF logs: containers are inflated whole, and their frames taken out a column at a time."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path

from typedcan.logs.frames import FrameBlock
from typedcan.logs.read.blf_containers import BrokenLog, batches, containers
from typedcan.logs.read.blf_stream import ObjectStream
from typedcan.logs.read.blocks import reblock
from typedcan.logs.read.source import BLOCK_SIZE, Damage, FileSource, Start

_HEADER = struct.Struct("<4sL8sQ16x8H16x")  # signature, header size, writer, file size, start
_PYTHON_CAN = bytes([5, 0, 0, 0, 2, 6, 8, 1])
"""What it says about itself: it writes UTC, others the clock of the recorder."""

_1970 = datetime(1970, 1, 1)
_BATCH = 2**19
"""Bytes that are looked through together: few calls for each, and they stay in the cache."""


class BlfSource(FileSource):
    """A BLF log: objects that are no frame on the bus are passed over, some of them counted.

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
    """

    def __init__(self, path: Path, block_size: int = BLOCK_SIZE) -> None:
        super().__init__(path, block_size)
        self._file = path.open("rb")

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def __iter__(self) -> Iterator[FrameBlock]:
        """The frames, in blocks."""
        return reblock(self._frames(), self._block_size)

    def _frames(self) -> Iterator[FrameBlock]:
        header_size, expected = self._header()
        if not header_size:
            problem = "this is not the header of a BLF file"
            self.damage = Damage(self.path, "byte 0", problem, f"{self._size:,} bytes")
            return
        self._file.seek(header_size)
        seconds = (self.start.wall - _1970).total_seconds() if self.start else 0.0
        objects = ObjectStream(seconds)
        self._passed = objects.passed
        try:
            for batch in batches(containers(self._file, self._size), _BATCH):
                self._position = batch[-1].end
                yield from objects.frames(batch)
            objects.check_end(self._size, expected)
        except BrokenLog as error:
            lost = max(self._size + error.missing, expected) - error.at
            self.damage = Damage(self.path, f"byte {error.at}", str(error), f"{lost:,} bytes")
        else:
            self._position = self._size

    def _header(self) -> tuple[int, int]:
        """Size of the header (0 if there is none), and of the file as it says."""
        header = self._file.read(_HEADER.size)
        if len(header) < _HEADER.size or not header.startswith(b"LOGG"):
            return 0, 0
        _, header_size, writer, file_size, *start = _HEADER.unpack(header)
        if header_size > self._size:
            return 0, 0
        wall = _date(start)
        if wall is not None:
            self.start = Start(wall, is_utc=writer == _PYTHON_CAN, counted=False)
        return max(header_size, _HEADER.size), file_size


def _date(words: list[int]) -> datetime | None:
    """Year, month, day of the week, day, hour, minute, second and millisecond; None if it lacks."""
    year, month, _, day, hour, minute, second, millis = words
    try:
        return datetime(year, month, day, hour, minute, second, 1000 * millis)
    except ValueError:
        return None
