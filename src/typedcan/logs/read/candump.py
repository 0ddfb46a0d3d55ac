"""candump logs, as `candump -l` of can-utils and python-can write them, and what candump shows."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from typedcan.logs.read.candump_screen import ScreenLines
from typedcan.logs.read.columns import Columns
from typedcan.logs.read.frame import (
    BIT_RATE_SWITCH,
    COMMENT,
    ERROR,
    ERROR_STATE,
    EXTENDED,
    FD,
    LARGEST_ID,
    REMOTE,
    SENT,
    Frame,
    Other,
    checked,
)
from typedcan.logs.read.payload import HEX
from typedcan.logs.read.source import BLOCK_SIZE
from typedcan.logs.read.text import TextSource
from typedcan.logs.read.text_format import TextFormat

_ERROR_FRAME = 0x20000000
_LINE = re.compile(
    r"\((?P<time>\d{1,12}(?:\.\d{1,12})?)\)\s+(?P<channel>\S+)\s+(?P<id>[\dA-Fa-f]{1,8})#"
    r"(?:#(?P<fd>[\dA-Fa-f])(?P<fd_data>[\dA-Fa-f.]*)|(?P<remote>[Rr]\d?)|(?P<data>[\dA-Fa-f.]*))"
    r"(?:_(?P<dlc>[\dA-Fa-f]))?(?:\s+(?P<direction>[RTrt]))?\s*$"
)
_XL = re.compile(r"\(\d+\.\d+\)\s+\S+\s+[\dA-Fa-f]+#[\dA-Fa-f]{2}:[\dA-Fa-f]{2}:[\dA-Fa-f]{8}#")


class CandumpFormat(TextFormat):
    """``(1436509052.249713) vcan0 123#DEADBEEF``, with `` R`` or `` T`` behind it or without."""

    name = "a candump log"
    patterns = (
        re.compile(
            rb"\((?P<whole>\d{1,10})\.(?P<fraction>\d{1,9})\) \S+ "
            rb"(?P<id>[\dA-Fa-f]{1,8})#(?:#\d)?(?P<data>(?:[\dA-Fa-f]{2})*)(?: [RTrt])?\r?\n"
        ),
    )
    payload = HEX

    def __init__(self) -> None:
        self._screen = ScreenLines()

    def read(self, line: str) -> Frame | Other:
        """A line of a file, or one that was shown."""
        found = _LINE.match(line.strip())
        if found is None:
            if line.lstrip().startswith("#") or _XL.match(line.strip()):
                return COMMENT if line.lstrip().startswith("#") else Other("CAN XL frames")
            return self._screen.read(line)
        return _frame(found)

    def reckon(self, columns: Columns, others: list[tuple[int, Other]]) -> None:
        """Times that were shown may count from the line before."""
        del others
        if self._screen.is_used:
            filled = np.flatnonzero(columns.filled)
            columns.timestamp[filled] = self._screen.reckon(columns.timestamp[filled])
            self.start = self._screen.start


def _frame(found: re.Match[str]) -> Frame:
    name = found["id"]
    frame_id = int(name, 16)
    flags = EXTENDED if len(name) > 3 else 0
    flags |= ERROR if frame_id & _ERROR_FRAME else 0
    flags |= SENT if found["direction"] in ("T", "t") else 0
    channel = found["channel"]
    time = float(found["time"])
    frame_id &= LARGEST_ID
    bus = int(channel) if channel.isdecimal() and len(channel) < 9 else channel
    if found["remote"]:
        length = int(found["remote"][1:] or "0")
        return checked(Frame(time, frame_id, flags | REMOTE, bus, length, b""))
    if found["fd"]:
        bits = int(found["fd"], 16)
        flags |= FD | BIT_RATE_SWITCH * (bits & 1) | ERROR_STATE * (bits >> 1 & 1)
    data = bytes.fromhex(_plain(found["fd_data"] if found["fd"] else found["data"]))
    return checked(Frame(time, frame_id, flags, bus, len(data), data))


def _plain(digits: str) -> str:
    """Dots may stand between bytes."""
    if "." in digits:
        if any(len(part) != 2 for part in digits.split(".")):
            raise ValueError("dots stand between bytes only")
        return digits.replace(".", "")
    return digits


class CandumpSource(TextSource):
    """A candump log; see `TextSource`."""

    def __init__(self, path: Path, block_size: int = BLOCK_SIZE) -> None:
        super().__init__(path, block_size, CandumpFormat())
