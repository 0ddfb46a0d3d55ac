"""CSV logs as python-can writes them."""

from __future__ import annotations

import io
import re
from pathlib import Path

import can

from typedcan.logs.read.one_by_one import OneByOne
from typedcan.logs.read.payload import BASE64
from typedcan.logs.read.source import BLOCK_SIZE
from typedcan.logs.read.text import TextSource


class CsvFormat:
    """``1483389946.197,0x00dadada,1,0,0,6,WzQyLCA5XQ==``."""

    name = "a CSV log of python-can"
    pattern = re.compile(
        rb"(?P<whole>\d{1,10})\.(?P<fraction>\d{1,9}),0x(?P<id>[\dA-Fa-f]{1,8}),"
        rb"[01],[01],[01],\d{1,2},(?P<data>[A-Za-z0-9+/]*)=*\r?\n"
    )
    payload = BASE64
    time_unit = 1
    origin = 0.0

    def __init__(self) -> None:
        self.warnings: list[str] = []
        self.lines = OneByOne(can.CSVReader(io.StringIO()), "the header")
        self._begun = False

    def is_header(self, line: bytes) -> bool:
        """The first line, unless it is a frame: python-can appends to a new file without it."""
        begun, self._begun = self._begun, True
        return not begun and not self.pattern.fullmatch(line + b"\n")

    def read(self, line: str) -> can.Message | None:
        """As python-can."""
        return self.lines.read(line)


class CsvSource(TextSource):
    """A CSV log of python-can; see `TextSource`."""

    def __init__(self, path: Path, block_size: int = BLOCK_SIZE) -> None:
        super().__init__(path, block_size, CsvFormat())
