"""What candump shows on a screen, and somebody kept in a file."""

from __future__ import annotations

import re
from datetime import datetime

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.read.frame import (
    BIT_RATE_SWITCH,
    ERROR,
    ERROR_STATE,
    EXTENDED,
    FD,
    LARGEST_ID,
    REMOTE,
    SENT,
    Frame,
    checked,
)
from typedcan.logs.read.source import Start

_1970 = datetime(1970, 1, 1)
_ERROR_FRAME = 0x20000000
_LARGEST_DELTA = 1e8  # seconds: three years; what is later are seconds since 1970
_NANOSECONDS = 1e9

_LINE = re.compile(
    r"\s*(?:\((?:(?P<date>\d{4}-\d\d-\d\d \d\d:\d\d:\d\d\.\d{1,9})|(?P<time>\d{1,12}\.\d{1,9}))\)"
    r"\s+)?(?P<channel>\S+)\s+(?:(?P<direction>RX|TX) (?P<brs>[B-]) (?P<esi>[E-])\s+)?"
    r"(?P<id>[\dA-Fa-f]{3}|[\dA-Fa-f]{8})\s+(?:\[(?P<length>\d{1,2})\]|\{(?P<dlc>[\dA-Fa-f])\})"
    r"(?:\s+(?P<rest>.*))?$"
)
_BYTE = re.compile(r"[\dA-Fa-f]{2}$")
_BITS = re.compile(r"[01]{8}$")


class ScreenLines:
    """``(000.000000)  can0  RX - -  123   [8]  DE AD BE EF DE AD BE EF``; time and flags may lack.

    ``is_used`` says that there was such a line, ``start`` when the first one was shown, where the
    lines have dates.
    """

    def __init__(self) -> None:
        self.is_used = False
        self.start: Start | None = None
        self._counts: bool | None = None
        self._last = 0.0

    def read(self, line: str) -> Frame:
        """The frame; raises `ValueError` where there is none."""
        found = _LINE.match(line.rstrip())
        if found is None:
            raise ValueError("no line of candump")
        self.is_used = True
        time = float(found["time"] or 0)
        if found["date"]:
            wall = datetime.fromisoformat(found["date"][:26])
            self.start = self.start or Start(wall, is_utc=False, counted=False)
            time = (wall - _1970).total_seconds()
        return _frame(found, time)

    def reckon(self, times: NDArray[np.float64]) -> NDArray[np.float64]:
        """Times from the line before (``-td``) are added up: such are not in order."""
        if self._counts is None and len(times):
            falls = bool((np.diff(times) < 0).any())
            self._counts = falls and float(times.max()) < _LARGEST_DELTA and self.start is None
        if self._counts and len(times):
            times = self._last + np.rint(times * _NANOSECONDS).cumsum() / _NANOSECONDS
            self._last = float(times[-1])
        return times


def _frame(found: re.Match[str], time: float) -> Frame:
    frame_id = int(found["id"], 16)
    flags = EXTENDED if len(found["id"]) > 3 else 0
    flags |= SENT if found["direction"] == "TX" else 0
    flags |= ERROR if frame_id & _ERROR_FRAME else 0
    flags |= BIT_RATE_SWITCH if found["brs"] == "B" else 0
    flags |= ERROR_STATE if found["esi"] == "E" else 0
    length = 8 if found["dlc"] else int(found["length"])
    if not found["dlc"] and len(found["length"]) == 2:
        flags |= FD
    rest = (found["rest"] or "").replace("`", " ")
    channel = found["channel"]
    if rest.startswith("remote request"):
        return checked(Frame(time, frame_id & LARGEST_ID, flags | REMOTE, channel, length, b""))
    data = bytes(_byte(token) for token in rest.split()[:length])
    if "`" in (found["rest"] or ""):
        data = data[::-1]  # shown with the last byte first
    return checked(
        Frame(time, frame_id & LARGEST_ID, flags, channel, len(data), _all(data, length))
    )


def _byte(token: str) -> int:
    if _BYTE.match(token):
        return int(token, 16)
    if _BITS.match(token):
        return int(token, 2)
    raise ValueError("no byte")


def _all(data: bytes, length: int) -> bytes:
    if len(data) != length:
        raise ValueError("the length and the payload do not agree")
    return data
