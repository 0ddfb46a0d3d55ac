"""Log files through python-can, with every damage an error: its readers pass over some of it."""

from __future__ import annotations

import logging
import sqlite3
import struct
import zlib
from collections.abc import Iterator
from pathlib import Path

import can
from can.io.blf import BLFParseError
from can.io.generic import MessageReader

from typedcan.model.errors import one_line
from typedcan.shell.console import CommandError

_DAMAGE = (
    BLFParseError,
    EOFError,  # gzip
    IndexError,
    KeyError,
    NotImplementedError,  # a version of the format, or a package that is missing
    OSError,
    TypeError,
    ValueError,
    sqlite3.Error,
    struct.error,
    zlib.error,
)


class LogFileError(CommandError):
    """A log file that is damaged, or cut short."""


class _Complaints(logging.Handler):
    """What python-can's readers log about lines that they leave out."""

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.texts: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        """Keep the text."""
        if record.args != ("",):  # TRCReader complains of an empty file
            self.texts.append(record.getMessage())


def read_log(path: Path) -> Iterator[can.Message]:
    """The frames of a log.

    Raises `CommandError` where there is no such log, and `LogFileError`, after the frames that
    could be read, where it is damaged.
    """
    complaints = _Complaints()
    logger = logging.getLogger("can.io")
    logger.addHandler(complaints)
    try:
        with _open(path) as reader:
            yield from map(_checked, reader)
            if isinstance(reader, can.BLFReader) and path.suffix.lower() == ".blf":
                _check_size(path, reader.file_size)
    except _DAMAGE as error:
        raise LogFileError(f"{path}: damaged: {_reason(error)}") from None
    finally:
        logger.removeHandler(complaints)
    if complaints.texts:
        count = len(complaints.texts)
        raise LogFileError(f"{path}: damaged: lines left out: {count}, {complaints.texts[0]}")


def _open(path: Path) -> MessageReader:
    try:
        path.open("rb").close()  # SQLite would create a file that is not there
    except OSError as error:
        raise CommandError(f"{path}: {error.strerror}") from None
    try:
        return can.LogReader(path)
    except _DAMAGE as error:
        packed = path.suffix.lower() == ".gz"
        if (path.with_suffix("") if packed else path).suffix.lower() in can.io.MESSAGE_READERS:
            raise CommandError(f"{path}: cannot be read: {_reason(error)}") from None
        known = ", ".join(sorted(can.io.MESSAGE_READERS))
        raise CommandError(f"{path}: no log of a known kind; known are {known}") from None


def _checked(frame: can.Message) -> can.Message:
    """The frame, if it is one: a damaged SQLite file gives rows without values."""
    if not (isinstance(frame.arbitration_id, int) and isinstance(frame.timestamp, int | float)):
        raise ValueError("a frame without identifier or time")  # noqa: TRY004
    return frame


def _reason(error: Exception) -> str:
    return "it ends too early" if isinstance(error, EOFError | struct.error) else one_line(error)


def _check_size(path: Path, expected: int) -> None:
    """A BLF file that was cut short: python-can reads what is left of it without a word."""
    size = path.stat().st_size
    if size < expected:
        raise ValueError(f"{size} bytes are left of {expected}")
