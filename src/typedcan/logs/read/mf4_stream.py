"""The bytes of an MF4 file as asammdf may have them: a damaged file cannot lead it in circles."""

from __future__ import annotations

import io
import shutil
import tempfile
from collections import Counter
from pathlib import Path

_IN_LISTS = frozenset({b"##AT", b"##CG", b"##CN", b"##DG", b"##DL", b"##EV", b"##FH", b"##HL"})
"""Blocks that just one other block refers to."""

_MOST_READS = {True: 100, False: 20_000}
"""Of the same place of a file, by whether such a block is there."""

_ID_SIZE = 64
_UNFINISHED = 60
"""From this byte of the first 64 on stands what is unfinished, or zero."""


class CircleError(ValueError):
    """A list of blocks leads back to where it began."""


class _Watched(io.BufferedIOBase):
    """Raises `CircleError` where the same bytes are read again and again."""

    _reads: Counter[int]

    def read(self, size: int | None = -1, /) -> bytes:
        """Bytes from here on."""
        place = self.tell()
        data = super().read(size)
        self._reads[place] += 1
        if self._reads[place] > _MOST_READS[data[:4] in _IN_LISTS]:
            raise CircleError(f"the list of blocks at byte {place} has no end")
        return data


class _Reader(_Watched, io.BufferedReader):
    def __init__(self, path: Path) -> None:
        super().__init__(io.FileIO(path, "rb"))
        self._reads = Counter()


class _Copy(_Watched, io.BufferedRandom):
    def __init__(self, path: Path) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="typedcan-")
        copy = Path(self._folder.name, path.name)
        shutil.copyfile(path, copy)
        super().__init__(io.FileIO(copy, "rb+"))
        self._reads = Counter()

    def close(self) -> None:
        super().close()
        self._folder.cleanup()


def open_stream(path: Path) -> io.BufferedIOBase:
    """The file, or a copy of one that its recorder never finished: asammdf finishes it in place."""
    with path.open("rb") as file:
        unfinished = any(file.read(_ID_SIZE)[_UNFINISHED:])
    return _Copy(path) if unfinished else _Reader(path)
