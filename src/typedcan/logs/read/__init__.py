"""Log files of every kind as blocks of frames: `open_log` finds the reader."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from typedcan.logs.read.asc import AscSource
from typedcan.logs.read.blf import BlfSource
from typedcan.logs.read.candump import CandumpSource
from typedcan.logs.read.csv import CsvSource
from typedcan.logs.read.mf4 import Mf4Source
from typedcan.logs.read.other import OtherSource
from typedcan.logs.read.source import BLOCK_SIZE, Damage, LogError, LogSource
from typedcan.logs.read.trc import TrcSource

__all__ = ["BLOCK_SIZE", "Damage", "LogError", "LogSource", "open_log"]

_TEXT: dict[str, Callable[[Path, int], LogSource]] = {
    ".asc": AscSource,
    ".csv": CsvSource,
    ".log": CandumpSource,
    ".trc": TrcSource,
}
_BINARY: dict[str, Callable[[Path, int], LogSource]] = {".blf": BlfSource, ".mf4": Mf4Source}


def open_log(path: Path, block_size: int = BLOCK_SIZE) -> LogSource:
    """Open a log with the reader that its suffix asks for.

    Parameters
    ----------
    path
        A log; ``.gz`` behind the suffix of a text log says that gzip compressed it.
    block_size
        Frames in a block.

    Raises
    ------
    LogError
        Where there is no such file, its kind is unknown, or a package is missing that it needs.
    """
    suffix = path.suffix.lower()
    readers = _TEXT | _BINARY
    if suffix == ".gz":
        readers = _TEXT
        suffix = Path(path.stem).suffix.lower()
        if suffix not in _TEXT:
            raise LogError(f"{path}: unpack it first; of packed logs only text is read")
    try:
        path.open("rb").close()
        return readers.get(suffix, OtherSource)(path, block_size)
    except OSError as error:
        raise LogError(f"{path}: {error.strerror or error}") from None
