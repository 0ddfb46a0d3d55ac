"""TRC logs of PEAK's tools and of python-can, of the versions 1.0 to 2.1."""

from __future__ import annotations

import re
from datetime import datetime, timedelta
from pathlib import Path

from typedcan.logs.read.dates import date_in
from typedcan.logs.read.frame import COMMENT, Frame, Other
from typedcan.logs.read.payload import SPACED_HEX
from typedcan.logs.read.source import BLOCK_SIZE, Start
from typedcan.logs.read.text import TextSource
from typedcan.logs.read.text_format import TextFormat
from typedcan.logs.read.trc_lines import LINES, line_of_columns

_FIRST_DAY = datetime(1899, 12, 30)
_1970 = datetime(1970, 1, 1)
_MOST_DAYS = 2_900_000

_NUMBER = r"(?P<number>\d{1,10})"
_TIME = r"(?P<whole>\d{1,10})(?:\.(?P<fraction>\d{1,9}))?"
_ID = r"(?P<id>[\dA-F]{1,8})"
_DATA = r"(?P<data>(?:[\dA-F]{2}(?:\x20[\dA-F]{2})*(?=\s))?)"
_TAIL = r"\s*(?P<tail>.*)"
_PATTERNS = {
    "1.0": rf"{_NUMBER}\) {_TIME} {_ID} \d+ {_DATA}{_TAIL}",
    "1.1": rf"{_NUMBER}\) {_TIME} [RT]x {_ID} \d+ {_DATA}{_TAIL}",
    "1.2": rf"{_NUMBER}\) {_TIME} \d+ [RT]x {_ID} \d+ {_DATA}{_TAIL}",
    "1.3": rf"{_NUMBER}\) {_TIME} \d+ [RT]x {_ID} \S+ \d+ {_DATA}{_TAIL}",
}
_COLUMNS = {"N": _NUMBER, "O": _TIME, "I": _ID, "D": _DATA + r"\s*"}


class TrcFormat(TextFormat):
    """``1) 1059.9 Rx 0300 8 DE AD BE EF DE AD BE EF``, and what other versions make of it."""

    name = "a TRC log"
    payload = SPACED_HEX
    time_unit = 1000

    def __init__(self) -> None:
        self._version = "1.0"
        self._columns: list[str] = []
        self._days: datetime | None = None
        self._date: datetime | None = None
        self._is_utc = False
        self._line = LINES["1.0"]

    def is_header(self, line: bytes) -> bool:
        """Lines that begin with a semicolon, up to the first one that does not."""
        line = line.strip()
        if not line.startswith(b";"):
            self._begin()
            return False
        key, _, value = line.partition(b"=")
        if key == b";$FILEVERSION":
            self._version = value.decode().strip()
        elif key == b";$COLUMNS":
            self._columns = value.decode().strip().split(",")
        elif key == b";$STARTTIME":
            days = float(value.replace(b",", b"."))
            if not 0 <= days < _MOST_DAYS:
                raise ValueError("no day that a calendar has")
            self._days = _FIRST_DAY + timedelta(days=days)
            self.origin = (self._days - _1970).total_seconds()
        elif b"start time:" in line.lower():
            self._date = date_in(line)
        elif b"python-can" in line:
            self._is_utc = True
        return True

    def read(self, line: str) -> Frame | Other:
        """The frame in a line, or what else it holds."""
        line = line.strip()
        return COMMENT if line.startswith(";") else self._line(line)

    def _begin(self) -> None:
        """The header is complete: it says how the lines of frames look."""
        if self._version not in ("1.1", "1.2", "1.3", "2.0", "2.1"):
            self._version = "1.0"
        if self._version == "1.0":
            self.origin, self._days = 0.0, None
        wall = self._days or self._date
        if wall is not None:
            self.start = Start(wall, self._is_utc, counted=self._days is None)
        if self._version in _PATTERNS:
            self._line = LINES[self._version]
            pattern = _PATTERNS[self._version]
        else:
            self._line = line_of_columns(self._columns)
            if not {"O", "I", "D"} <= {*self._columns}:
                return
            pattern = " ".join(_COLUMNS.get(column, r"\S+") for column in self._columns)
        self.patterns = (_compiled(pattern),)


def _compiled(line: str) -> re.Pattern[bytes]:
    """A blank in the pattern stands for any number of them."""
    return re.compile((r"\s*" + line.replace(" ", r"\s+")).encode(), re.DOTALL | re.IGNORECASE)


class TrcSource(TextSource):
    """A TRC log; see `TextSource`."""

    def __init__(self, path: Path, block_size: int = BLOCK_SIZE) -> None:
        super().__init__(path, block_size, TrcFormat())
