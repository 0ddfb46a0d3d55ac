"""Log files of every kind as blocks of frames: `open_log` finds the reader."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from typedcan.logs.read.asc import AscSource
from typedcan.logs.read.blf import BlfSource
from typedcan.logs.read.busmaster import BusmasterSource
from typedcan.logs.read.candump import CandumpSource
from typedcan.logs.read.csv import CsvSource, GvretSource
from typedcan.logs.read.detect import Head
from typedcan.logs.read.mf4 import Mf4Source
from typedcan.logs.read.other import OtherSource
from typedcan.logs.read.packed import PackedSource
from typedcan.logs.read.pcap import PcapSource
from typedcan.logs.read.source import BLOCK_SIZE, Damage, LogError, LogSource
from typedcan.logs.read.trc import TrcSource

__all__ = ["BLOCK_SIZE", "Damage", "LogError", "LogSource", "open_log"]

_Opener = Callable[[Path, int], LogSource]
_TEXT: dict[str, _Opener] = {
    "asc": AscSource,
    "busmaster": BusmasterSource,
    "candump": CandumpSource,
    "csv": CsvSource,
    "gvret": GvretSource,
    "trc": TrcSource,
}
_BINARY: dict[str, _Opener] = {
    "blf": BlfSource,
    "mf4": Mf4Source,
    "other": OtherSource,
    "pcap": PcapSource,
    "pcapng": PcapSource,
}
_BY_SUFFIX = {
    ".asc": "asc",
    ".blf": "blf",
    ".csv": "csv",
    ".log": "candump",
    ".mf4": "mf4",
    ".pcap": "pcap",
    ".pcapng": "pcapng",
    ".trc": "trc",
}


def open_log(path: Path, block_size: int = BLOCK_SIZE) -> LogSource:
    """Open a log with the reader for what it holds, plain or packed by gzip.

    Its suffix decides only where its begin does not tell.

    Parameters
    ----------
    path
        A log.
    block_size
        Frames in a block.

    Raises
    ------
    LogError
        Where there is no such file, it is no log that can be read, or a package is missing that
        it needs.
    """
    try:
        head = Head(path)
        kind = head.kind()
        suffix = Path(path.stem if head.is_packed else path).suffix.lower()
        if not kind:
            if foreign := head.foreign():
                raise LogError(f"{path}: {foreign}")
            kind = _BY_SUFFIX.get(suffix, "other")
        if kind in _TEXT:
            return _TEXT[kind](path, block_size)
        if head.is_packed:
            return PackedSource(path, block_size, _BINARY[kind])
        return _BINARY[kind](path, block_size)
    except OSError as error:
        raise LogError(f"{path}: {error.strerror or error}") from None
