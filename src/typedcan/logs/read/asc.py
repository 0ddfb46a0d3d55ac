"""ASC logs of Vector's tools, of can-utils and of python-can."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from typedcan.logs.read.asc_clock import AscClock
from typedcan.logs.read.asc_lines import AscLines
from typedcan.logs.read.columns import Columns
from typedcan.logs.read.dates import date_in
from typedcan.logs.read.frame import COMMENT, Frame, Other
from typedcan.logs.read.payload import SPACED_HEX
from typedcan.logs.read.source import BLOCK_SIZE
from typedcan.logs.read.text import TextSource
from typedcan.logs.read.text_format import TextFormat

_DATA = rb"(?P<data>(?:[\dA-F]{2}(?: [\dA-F]{2})*(?=\s))?)"
_BEGIN = rb"\s*(?P<whole>\d{1,10})\.(?P<fraction>\d{1,9})\s+"
_HOW = re.DOTALL | re.IGNORECASE
_HEX_LINES = (
    re.compile(
        _BEGIN
        + rb"\d+\s+(?P<id>[\dA-F]{1,8})x?\s+[RT]x\s+d\s+\d+\s+"
        + _DATA
        + rb"\s*(?P<tail>.*)",
        _HOW,
    ),
    re.compile(
        _BEGIN + rb"CANFD\s+\d+\s+[RT]x\s+(?P<id>[\dA-F]{1,8})x?\s+(?:[A-Z_]\w*\s+)?[01]\s+[01]\s+"
        rb"[\dA-F]\s+\d+\s+"
        + _DATA
        + rb"(?P<skip>\s+\d+\s+\d+)(?P<flags>\s+[\dA-F]{1,8}\s)(?P<tail>.*)",
        _HOW,
    ),
)
"""Frames of classic CAN and of CAN FD; what follows is not read, but for the flags of CAN FD."""

_TIME = re.compile(rb"\s*(-?\d{1,10}(?:\.\d{1,9})?)(?:\s|$)")
_BASE = re.compile(rb"base\s+(hex|dec)\b(?:\s+timestamps\s+(absolute|relative))?", re.IGNORECASE)
_BLOCK = re.compile(rb"begin\s+trigger\s?block\b(.*)", re.IGNORECASE)
_DATE = re.compile(rb"date\s(.*)", re.IGNORECASE)


class AscFormat(TextFormat):
    """``0.123456 1  18FF45F4x       Rx   d 8 DE AD BE EF DE AD BE EF``, and CAN FD lines."""

    name = "an ASC log"
    payload = SPACED_HEX
    patterns: tuple[re.Pattern[bytes], ...] = _HEX_LINES

    def __init__(self) -> None:
        self._clock = AscClock()
        self._lines = AscLines()
        self._begins: list[Other] = []

    def is_header(self, line: bytes) -> bool:
        """All that stands before the first line with a time."""
        line = line.strip()
        if _TIME.match(line):
            return False
        if date := _DATE.match(line):
            self._clock.header = date_in(date[1])
        elif base := _BASE.match(line):
            self._lines.base = 16 if base[1].lower() == b"hex" else 10
            self.patterns = _HEX_LINES if self._lines.base == 16 else ()
            self._clock.is_relative = (base[2] or b"").lower() == b"relative"
        elif (other := self._block(line)) is not None:
            self._begins = [other]
        return True

    def read(self, line: str) -> Frame | Other:
        """The frame or event in a line with a time; else a trigger block may begin."""
        line = line.strip()
        if line[:1].isdigit() or line[:1] == "-":
            return self._lines.read(line)
        raw = line.encode(errors="surrogateescape")
        base = _BASE.match(raw)
        if base and (base[1].lower() == b"hex") != (self._lines.base == 16):
            raise ValueError("the base of numbers changes amid the log")
        return self._block(raw) or COMMENT

    def _block(self, line: bytes) -> Other | None:
        block = _BLOCK.match(line)
        date = date_in(block[1]) if block else None
        return Other("", begins=date) if date else None

    def time_of(self, line: bytes) -> float:
        """A line that makes no sense has a time all the same, from which the next one counts."""
        time = _TIME.match(line)
        return float(time[1]) if time else np.nan

    def reckon(self, columns: Columns, others: list[tuple[int, Other]]) -> None:
        """Let times count from the begin of the log."""
        others = [*((0, other) for other in self._begins), *others]
        self._begins = []
        times = np.where(columns.filled, columns.timestamp, np.nan)
        for row, other in others:
            if other.begins is None:
                times[row] = other.timestamp
        blocks = [(row, other.begins) for row, other in others if other.begins is not None]
        columns.timestamp = self._clock.reckon(times, blocks)
        self.start = self._clock.start
        if self._lines.has_names:
            self.patterns = ()  # names may look like numbers


class AscSource(TextSource):
    """An ASC log; see `TextSource` and `AscFormat`."""

    def __init__(self, path: Path, block_size: int = BLOCK_SIZE) -> None:
        super().__init__(path, block_size, AscFormat())
