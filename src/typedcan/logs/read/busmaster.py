"""Logs of BUSMASTER."""

from __future__ import annotations

import re
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np

from typedcan.logs.read.columns import Columns
from typedcan.logs.read.dates import date_in
from typedcan.logs.read.frame import (
    COMMENT,
    ERROR,
    EXTENDED,
    FD,
    REMOTE,
    SENT,
    Frame,
    Other,
    checked,
    joined_bytes,
)
from typedcan.logs.read.source import BLOCK_SIZE, Start
from typedcan.logs.read.text import TextSource
from typedcan.logs.read.text_format import TextFormat

_1970 = datetime(1970, 1, 1)
_DAY = 86_400.0
_TIME = re.compile(r"(\d{1,6}):(\d{1,2}):(\d{1,2}):(\d{1,4})$")
_MODE = re.compile(r"\*{3}(ABSOLUTE|RELATIVE|SYSTEM) MODE\*{3}")
_BEGIN = re.compile(r"\*{3}START DATE AND TIME(.*)")
_DATE = re.compile(r"(\d\d?):(\d\d?):(\d{4})\s+(\d\d?):(\d\d?):(\d\d?):(\d{1,3})(?!\d)")
_FLAGS = {
    "s": 0,
    "x": EXTENDED,
    "sr": REMOTE,
    "xr": EXTENDED | REMOTE,
    "s-fd": FD,
    "x-fd": EXTENDED | FD,
    "sfd": FD,
    "xfd": EXTENDED | FD,
}


class BusmasterFormat(TextFormat):
    """``11:49:12:9420 Rx 1 0x023 s 1 40``: the last number of the time is tenths of milliseconds.

    Times are those of the day (``SYSTEM MODE``), or count from the begin of the session, or from
    the line before. A file may hold several sessions.
    """

    name = "a BUSMASTER log"

    def __init__(self) -> None:
        self._mode = "SYSTEM"
        self._base = 16
        self._session: datetime | None = None
        self._last = 0.0

    def read(self, line: str) -> Frame | Other:
        """A frame, or a line between asterisks that says how the ones behind it are meant."""
        line = line.strip()
        if line.startswith("***"):
            return self._setting(line)
        tokens = line.split()
        time = _seconds(tokens[0])
        if len(tokens) > 1 and tokens[1].lower().startswith("err"):
            return Frame(time, 0, EXTENDED | ERROR, _channel(tokens[2]), 0, b"")
        direction, channel, name, kind, count, *data = tokens[1:]
        flags = {"rx": 0, "tx": SENT}[direction.lower()] | _FLAGS[kind.lower()]
        if len(name) > 10 or len(count) > 2:
            raise ValueError("no number")
        length = int(count)
        payload = b"" if flags & REMOTE else joined_bytes(data[:length], self._base)
        flags |= FD if length > 8 else 0
        frame_id = int(name, self._base)
        return checked(Frame(time, frame_id, flags, _channel(channel), length, payload))

    def _setting(self, line: str) -> Other:
        if mode := _MODE.match(line):
            self._mode = mode[1]
        elif line in ("***HEX***", "***DEC***"):
            self._base = 16 if "HEX" in line else 10
        elif begin := _BEGIN.match(line):
            date = _date(begin[1])
            return Other("", begins=date) if date else COMMENT
        return COMMENT

    def reckon(self, columns: Columns, others: list[tuple[int, Other]]) -> None:
        """Of times of the day make seconds since 1970; of others, seconds since the begin."""
        rows = [row for row, other in others if other.begins]
        dates = [other.begins for _, other in others if other.begins]
        places = [0, *rows, len(columns.filled)]
        for first, last, date in zip(places, places[1:], [None, *dates], strict=False):
            if date is not None:
                self._begin(date)
            filled = first + np.flatnonzero(columns.filled[first:last])
            for row in filled.tolist():
                columns.timestamp[row] = self._time(float(columns.timestamp[row]))

    def _begin(self, date: datetime) -> None:
        self._session = date
        counted = self._mode != "SYSTEM"
        if self.start is None:
            self.start = Start(date, is_utc=False, counted=counted)
        since = (date - self.start.wall).total_seconds()
        self._last = since if counted else (date - _1970).total_seconds()
        self.origin = since if counted else (_midnight(date) - _1970).total_seconds()

    def _time(self, time: float) -> float:
        if self._mode == "RELATIVE":
            self._last = round(self._last + time, 4)
            return self._last
        time += self.origin
        if self._mode == "SYSTEM" and time < self._last - _DAY / 2:
            self.origin += _DAY  # midnight has passed
            time += _DAY
        self._last = time
        return time


def _date(text: str) -> datetime | None:
    """``30:6:2025 14:5:0:123``: day, month, year, and the time to milliseconds."""
    found = _DATE.search(text)
    if found is None:
        return date_in(text.encode(errors="surrogateescape"))
    day, month, year, hour, minute, second, millis = (int(each) for each in found.groups())
    return datetime(year, month, day, hour, minute, second, 1000 * millis)


def _midnight(date: datetime) -> datetime:
    return date - timedelta(
        hours=date.hour, minutes=date.minute, seconds=date.second, microseconds=date.microsecond
    )


def _seconds(text: str) -> float:
    found = _TIME.match(text)
    if found is None:
        raise ValueError("no time")
    hours, minutes, seconds = (int(each) for each in found.groups()[:3])
    return float(f"{3600 * hours + 60 * minutes + seconds}.{found[4]}")


def _channel(text: str) -> int:
    if not text.isdecimal() or len(text) > 4:
        raise ValueError("no number of a channel")
    return int(text)


class BusmasterSource(TextSource):
    """A log of BUSMASTER; see `TextSource`."""

    def __init__(self, path: Path, block_size: int = BLOCK_SIZE) -> None:
        super().__init__(path, block_size, BusmasterFormat())
