"""What every log reader is, and how it says that a file is damaged."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from types import TracebackType
from typing import Protocol, Self

from typedcan.logs.frames import FrameBlock
from typedcan.model.errors import TypedcanError

BLOCK_SIZE = 65_536
"""Frames in a block, unless the caller wants another number."""


class LogError(TypedcanError):
    """A log cannot be opened: there is none, or nothing here reads such a file."""


@dataclass(frozen=True, slots=True)
class Damage:
    """Where a log broke: every frame before it is delivered, of those behind it what can be read.

    Parameters
    ----------
    path
        The log.
    where
        The place in the file, such as ``byte 123456`` or ``line 17``.
    problem
        What is wrong there, in one line.
    lost
        How much of the file is lost, such as ``3,412 bytes``.
    """

    path: Path
    where: str
    problem: str
    lost: str

    def __str__(self) -> str:
        """One line for a person."""
        return f"{self.path}: damaged at {self.where}: {self.problem}; lost: {self.lost}"


@dataclass(frozen=True, slots=True)
class Start:
    """When a log says that it began.

    Parameters
    ----------
    wall
        Date and time as the file has them, without a zone.
    is_utc
        What wrote the file is known to write UTC; else it is the clock of the recorder.
    counted
        The times of the frames count from it; else they are seconds since 1970, as if it were UTC.
    """

    wall: datetime
    is_utc: bool
    counted: bool


class LogSource(Protocol):
    """A log that is open: iterate once over its blocks, then look at ``damage``."""

    path: Path

    damage: Damage | None
    """None until the iteration came upon damage, which never is an exception."""

    start: Start | None = None
    """When the log says that it began; known with its first block."""

    @property
    def passed(self) -> Counter[str]:
        """What in the file is no frame on the bus, by kind, such as ``transmit requests``."""
        return Counter()

    @property
    def size(self) -> int:
        """Bytes of the file."""
        ...

    @property
    def position(self) -> int:
        """Bytes of the file that have been read so far; equals ``size`` at the end."""
        ...

    def __iter__(self) -> Iterator[FrameBlock]:
        """The frames, in the file's order, in blocks that are never empty."""
        ...

    def close(self) -> None:
        """Close the file; more than once does no harm."""
        ...

    def __enter__(self) -> Self:
        """Itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close the file."""
        self.close()


class FileSource(LogSource):
    """What readers of a file have in common: how far they are, and what they passed over.

    Parameters
    ----------
    path
        The log.
    block_size
        Frames in a block.

    Raises
    ------
    OSError
        There is no such file.
    """

    def __init__(self, path: Path, block_size: int) -> None:
        self.path = path
        self.damage: Damage | None = None
        self._block_size = block_size
        self._size = path.stat().st_size
        self._position = 0
        self._passed: Counter[str] = Counter()

    @property
    def passed(self) -> Counter[str]:
        """What in the file is no frame on the bus, by kind."""
        return self._passed

    @property
    def size(self) -> int:
        """Bytes of the file."""
        return self._size

    @property
    def position(self) -> int:
        """Bytes of the file that have been read so far."""
        return self._position
