"""ASC logs of Vector's tools and of python-can."""

from __future__ import annotations

import io
import re
from pathlib import Path

import can

from typedcan.logs.read.one_by_one import OneByOne
from typedcan.logs.read.payload import SPACED_HEX
from typedcan.logs.read.source import BLOCK_SIZE
from typedcan.logs.read.text import TextSource

_NO_HEADER = "\n"
_A_FRAME = "0.0 1 ErrorFrame"

_HEX_LINE = re.compile(
    rb"\s*(?P<whole>\d{1,10})\.(?P<fraction>\d{1,9})\s+(?:CANFD\s+\d+\s+[RT]x|\d+)\s+"
    rb"(?P<id>[\dA-F]{1,8})x?\s+(?:[RT]x\s+d|(?:[A-Z_]\w*\s+)?[01]\s+[01]\s+[\dA-F])\s+\d+\s+"
    rb"(?P<data>(?:[\dA-F]{2}(?: [\dA-F]{2})*(?=\s))?)\s*(?P<tail>.*)",
    re.DOTALL | re.IGNORECASE,
)
"""Frames of classic CAN and of CAN FD; what follows the payload is not read."""


class AscFormat:
    """``0.123456 1  18FF45F4x       Rx   d 8 DE AD BE EF DE AD BE EF``, and CAN FD lines.

    Parameters
    ----------
    relative_timestamp
        Times count from the begin of the log, else from 1970, if the log says when it began.
    """

    name = "an ASC log"
    payload = SPACED_HEX
    time_unit = 1

    def __init__(self, *, relative_timestamp: bool) -> None:
        self._reader = can.ASCReader(io.StringIO(), relative_timestamp=relative_timestamp)
        self.warnings: list[str] = []
        self.lines = OneByOne(self._reader, _NO_HEADER)

    @property
    def pattern(self) -> re.Pattern[bytes] | None:
        """None for decimal numbers, which are rare."""
        return _HEX_LINE if self._reader.base == "hex" else None

    @property
    def origin(self) -> float:
        """The time of the header, or of the last trigger."""
        return self._reader.start_time

    def is_header(self, line: bytes) -> bool:
        """Date, base and comments. Unlike python-can, the line behind them is no part of it."""
        text = line.decode(errors="surrogateescape")
        return self.lines.first(text, _A_FRAME) is None

    def read(self, line: str) -> can.Message | None:
        """As python-can."""
        return self.lines.read(line)


class AscSource(TextSource):
    """An ASC log; see `TextSource` and `AscFormat`."""

    def __init__(
        self, path: Path, block_size: int = BLOCK_SIZE, *, relative_timestamp: bool = True
    ) -> None:
        super().__init__(path, block_size, AscFormat(relative_timestamp=relative_timestamp))
