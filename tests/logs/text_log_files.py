"""Text logs for tests: made by hand or by python-can, read with the damage that was found."""

from __future__ import annotations

from pathlib import Path

import can
from logs.log_files import Row, rows_by_python_can, rows_in, write_log

from typedcan.logs.read.asc import AscSource
from typedcan.logs.read.candump import CandumpSource
from typedcan.logs.read.csv import CsvSource
from typedcan.logs.read.source import Damage
from typedcan.logs.read.text import TextSource
from typedcan.logs.read.trc import TrcSource

TEXT_SUFFIXES = [".log", ".asc", ".csv", ".trc"]

_SOURCES: dict[str, type[CandumpSource | AscSource | CsvSource | TrcSource]] = {
    ".log": CandumpSource,
    ".asc": AscSource,
    ".csv": CsvSource,
    ".trc": TrcSource,
}


def open_text(path: Path, block_size: int = 1000) -> TextSource:
    """The source for a file, by the suffix before any ``.gz``."""
    suffix = path.suffixes[0]
    return _SOURCES[suffix](path, block_size)


def read_text(path: Path, block_size: int = 1000) -> tuple[list[Row], Damage | None]:
    """All frames, and the damage."""
    with open_text(path, block_size) as source:
        found = rows_in(source)
        return found, source.damage


def sound_rows(path: Path, block_size: int = 1000) -> list[Row]:
    """All frames of a log without damage."""
    found, damage = read_text(path, block_size)
    assert damage is None, damage
    return found


def agreed(path: Path, content: bytes) -> list[Row]:
    """What both readers give for this file."""
    path.write_bytes(content)
    found = sound_rows(path)
    assert found == rows_by_python_can(path)
    return found


def regular_log(path: Path, count: int) -> list[Row]:
    """A log of so many frames of 8 bytes from 25 senders, and what python-can reads in it."""
    frames = [
        can.Message(
            timestamp=1_700_000_000 + number * 0.001,
            arbitration_id=0x18FF0000 + 0x101 * (number % 25),
            data=(number * 0x0123456789ABCDEF % 2**64).to_bytes(8, "little"),
            channel=0,
        )
        for number in range(count)
    ]
    return rows_by_python_can(write_log(path, frames))
