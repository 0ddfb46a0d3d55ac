"""Packed logs that are no text: their readers need a file that is unpacked."""

from __future__ import annotations

import shutil
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

from typedcan.logs.frames import FrameBlock
from typedcan.logs.read.gunzip import BrokenGzip, gunzip
from typedcan.logs.read.source import Damage, LogError, LogSource

_LEFT_FREE = 2**30
_EACH = 256
"""After so many pieces it is looked how much room is left."""


class PackedSource(LogSource):
    """A log that gzip packed, unpacked into the folder for temporary files.

    Parameters
    ----------
    path
        The log.
    block_size
        Frames in a block.
    reader
        The reader for such a log unpacked.

    Raises
    ------
    LogError
        There is too little room for it, a gibibyte is left free; or the reader refuses it.
    """

    def __init__(
        self, path: Path, block_size: int, reader: Callable[[Path, int], LogSource]
    ) -> None:
        self.path = path
        self.damage: Damage | None = None
        self._size = path.stat().st_size
        self._folder = tempfile.TemporaryDirectory(prefix="typedcan-")
        self._log: LogSource | None = None
        copy = Path(self._folder.name, path.stem or "log")
        try:
            self._problem = self._unpack(copy)
            self._log = reader(copy, block_size)
        except LogError as error:
            self.close()
            raise LogError(str(error).replace(str(copy), str(path))) from None
        except BaseException:
            self.close()
            raise

    def _unpack(self, copy: Path) -> str:
        """Returns what is damaged."""
        with self.path.open("rb", buffering=0) as packed, copy.open("wb") as file:
            try:
                for number, piece in enumerate(gunzip(packed)):
                    if number % _EACH == 0 and _free(copy) < _LEFT_FREE:
                        raise LogError(f"{self.path}: unpack it first: there is no room here")
                    file.write(piece)
            except BrokenGzip as error:
                return str(error)
        return ""

    @property
    def passed(self) -> Counter[str]:
        """What in the log is no frame on the bus."""
        return self._log.passed if self._log else Counter()

    @property
    def size(self) -> int:
        """Bytes of the packed file."""
        return self._size

    @property
    def position(self) -> int:
        """Bytes of the packed file, by the share of the unpacked one that has been read."""
        if self._log is None or self._log.position >= self._log.size:
            return self._size
        return self._size * self._log.position // self._log.size

    def __iter__(self) -> Iterator[FrameBlock]:
        """The frames, in blocks."""
        if self._log is None:
            return
        for block in self._log:
            self.start = self._log.start
            yield block
        damage = self._log.damage
        if damage is not None:
            self.damage = replace(damage, path=self.path)
        elif self._problem:
            lost = "what follows"
            self.damage = Damage(self.path, f"byte {self._size}", self._problem, lost)

    def close(self) -> None:
        """Close the log and remove its unpacked copy."""
        if self._log is not None:
            self._log.close()
        self._folder.cleanup()


def _free(copy: Path) -> int:
    return shutil.disk_usage(copy.parent).free
