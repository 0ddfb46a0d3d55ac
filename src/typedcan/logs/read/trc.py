"""TRC logs of PEAK's tools and of python-can."""

from __future__ import annotations

import io
import re
from pathlib import Path

import can
from can.io.trc import TRCFileVersion

from typedcan.logs.read.one_by_one import OneByOne
from typedcan.logs.read.payload import SPACED_HEX
from typedcan.logs.read.source import BLOCK_SIZE
from typedcan.logs.read.text import NOT_A_FRAME, TextSource

_START = b";$STARTTIME"
_KEYS = (b";$FILEVERSION", _START, b";$COLUMNS")

_NUMBER = r"(?P<number>\d{1,10})"
_TIME = r"(?P<whole>\d{1,10})(?:\.(?P<fraction>\d{1,9}))?"
_ID = r"(?P<id>[\dA-F]{1,8})"
_DATA = r"(?P<data>(?:[\dA-F]{2}(?:\x20[\dA-F]{2})*(?=\s))?)"
_TAIL = r"\s*(?P<tail>.*)"
_LINES = {
    TRCFileVersion.UNKNOWN: rf"{_NUMBER}\) {_TIME} {_ID} \d+ {_DATA}{_TAIL}",
    TRCFileVersion.V1_1: rf"{_NUMBER}\) {_TIME} [RT]x {_ID} \d+ {_DATA}{_TAIL}",
    TRCFileVersion.V1_3: rf"{_NUMBER}\) {_TIME} \d+ [RT]x {_ID} \S+ \d+ {_DATA}{_TAIL}",
}
_COLUMNS = {"N": _NUMBER, "O": _TIME, "I": _ID, "D": _DATA + r"\s*"}


class TrcFormat:
    """``1) 1059.9 Rx 0300 8 DE AD BE EF DE AD BE EF``, and what other versions make of it."""

    name = "a TRC log"
    payload = SPACED_HEX
    time_unit = 1000
    pattern: re.Pattern[bytes] | None = None
    origin = 0.0

    def __init__(self) -> None:
        self._reader = can.TRCReader(io.StringIO())
        self.warnings: list[str] = []
        self.lines = OneByOne(self._reader)
        self._header: dict[bytes, str] = {}

    def is_header(self, line: bytes) -> bool:
        """Lines that begin with a semicolon, up to the first one that does not."""
        line = line.strip()
        if not line.startswith(b";"):
            self._begin()
            return False
        key = line.partition(b"=")[0]
        if key in _KEYS:
            text = line.decode()
            if key == _START:
                self.lines.first(text)  # raises if it is no number
            self._header[key] = text
        return True

    def read(self, line: str) -> can.Message | None:
        """As python-can, which only warns of a line that is too short: here it is an error."""
        if line.lstrip().startswith(";"):
            return None
        self.warnings.clear()
        frame = self.lines.read(line.strip())
        if self.warnings:
            raise ValueError("the line is too short")
        return frame

    def _begin(self) -> None:
        """The header is complete: it says how the lines of frames look."""
        self.lines.before = tuple(self._header.values())
        try:
            self.lines.first(*self.lines.before, "")
        except NOT_A_FRAME:
            return  # each line will say so
        version = self._reader.file_version
        start = self._reader.start_time
        if start is not None and version is not TRCFileVersion.UNKNOWN:
            self.origin = start.timestamp()
        columns = sorted(self._reader.columns, key=self._reader.columns.__getitem__)
        line = _LINES.get(version, " ".join(_COLUMNS.get(column, r"\S+") for column in columns))
        if {"O", "I", "D"} <= {*columns} or version in _LINES:
            self.pattern = _compiled(line)


def _compiled(line: str) -> re.Pattern[bytes]:
    """A blank in the pattern stands for any number of them."""
    return re.compile((r"\s*" + line.replace(" ", r"\s+")).encode(), re.DOTALL | re.IGNORECASE)


class TrcSource(TextSource):
    """A TRC log; see `TextSource`."""

    def __init__(self, path: Path, block_size: int = BLOCK_SIZE) -> None:
        super().__init__(path, block_size, TrcFormat())
