"""Single lines of TRC logs of every version."""

from __future__ import annotations

import re
from collections.abc import Callable

from typedcan.logs.read.frame import (
    BIT_RATE_SWITCH,
    ERROR,
    ERROR_STATE,
    EXTENDED,
    FD,
    LENGTHS,
    REMOTE,
    SENT,
    Frame,
    Other,
    checked,
    joined_bytes,
)

_NUMBER = re.compile(r"\d{1,10}(?:\.\d{1,9})?$")
_HEX = re.compile(r"[\dA-Fa-f]{1,8}$")

_STATUS = "changes of the bus status"
_EVENTS = "events"
_OVERLOAD = "overload frames"

_ERROR_LENGTH = 8
_KINDS = {
    "DT": 0,
    "FD": FD,
    "FB": FD | BIT_RATE_SWITCH,
    "FE": FD | BIT_RATE_SWITCH | ERROR_STATE,
    "BI": FD | ERROR_STATE,
    "RR": REMOTE,
}
_NO_FRAMES = {"ST": _STATUS, "EC": "error counters", "EV": _EVENTS, "OV": _OVERLOAD}
_DIRECTIONS = {"rx": 0, "tx": SENT}


def _time(text: str) -> float:
    if not _NUMBER.match(text):
        raise ValueError("the time is no number")
    return float(text) / 1000


def _id(text: str) -> tuple[int, int]:
    if not _HEX.match(text):
        raise ValueError("the identifier is no number")
    return int(text, 16), EXTENDED if len(text) > 4 else 0


def _small(text: str) -> int:
    if not text.isdecimal() or len(text) > 3:
        raise ValueError("no small number")
    return int(text)


def _error(time: float, flags: int, channel: int, tokens: list[str]) -> Frame:
    """An error frame has no identifier; the bytes say what and where the error was."""
    data = joined_bytes([token for token in tokens if _HEX.match(token)][:_ERROR_LENGTH])
    return checked(Frame(time, 0, flags | EXTENDED | ERROR, channel, len(data), data))


def _classic(time: float, name: str, flags: int, channel: int, rest: list[str]) -> Frame:
    """The rest of a line from the length on."""
    frame_id, extended = _id(name)
    length = _small(rest[0])
    if len(rest) > 1 and rest[1] == "RTR":
        return checked(Frame(time, frame_id, flags | extended | REMOTE, channel, length, b""))
    data = joined_bytes(rest[1 : 1 + length])
    return checked(Frame(time, frame_id, flags | extended, channel, length, data))


def _line_1_0(line: str) -> Frame | Other:
    """``number) time id length data``."""
    tokens = line.split()
    time = _time(tokens[1])
    if tokens[4:5] == ["ERROR"]:
        return _error(time, 0, 1, tokens[5:])
    if tokens[2] == "FFFFFFFF":
        return Other(_STATUS, time)
    return _classic(time, tokens[2], 0, 1, tokens[3:])


def _later(bus: int | None, reserved: int) -> Callable[[str], Frame | Other]:
    """``number) time [bus] kind id [reserved] length data``."""
    kind_at = 2 if bus is None else bus + 1

    def read(line: str) -> Frame | Other:
        tokens = line.split()
        time = _time(tokens[1])
        kind = tokens[kind_at]
        channel = 1 if bus is None else _small(tokens[bus])
        rest = tokens[kind_at + 2 + reserved :]
        if kind in ("Rx", "Tx"):
            return _classic(time, tokens[kind_at + 1], _DIRECTIONS[kind.lower()], channel, rest)
        if kind == "Error":
            return _error(time, 0, channel, rest[1:])
        if kind == "Warng":
            return Other(_STATUS, time)
        if kind.isalpha() and kind.isascii():
            return Other(_EVENTS, time)
        raise ValueError("the line is of no known kind")

    return read


LINES: dict[str, Callable[[str], Frame | Other]] = {
    "1.0": _line_1_0,
    "1.1": _later(None, 0),
    "1.2": _later(2, 0),
    "1.3": _later(2, 1),
}
"""Readers of lines, by version; they raise `ValueError` and `LookupError`."""


class _Columns:
    """A line of version 2: ``names`` are its columns, of which the last one holds all the rest."""

    def __init__(self, names: list[str]) -> None:
        self._at = {name: place for place, name in enumerate(names)}
        self._most = max(len(names) - 1, 0)

    def __call__(self, line: str) -> Frame | Other:
        at = self._at
        tokens = line.split(maxsplit=self._most)
        time = _time(tokens[at["O"]])
        kind = tokens[at["T"]]
        if kind in _NO_FRAMES:
            return Other(_NO_FRAMES[kind], time)
        channel = _small(tokens[at["B"]]) if "B" in at else 1
        if kind == "ER":
            return _error(time, self._direction(tokens), channel, line.split()[-5:])
        flags = _KINDS.get(kind)
        if flags is None:
            raise ValueError("the line is of no known kind")
        frame_id, extended = _id(tokens[at["I"]])
        flags |= extended | self._direction(tokens)
        length = self._length(tokens, flags)
        data = b""
        if length and not flags & REMOTE:
            data = joined_bytes(tokens[at["D"]].split()[:length])
        return checked(Frame(time, frame_id, flags, channel, length, data))

    def _direction(self, tokens: list[str]) -> int:
        if "d" not in self._at:
            return 0
        for token in (tokens[self._at["d"]], *tokens):  # columns without content may be missing
            if token in ("Rx", "Tx"):
                return _DIRECTIONS[token.lower()]
        raise ValueError("the line has no direction")

    def _length(self, tokens: list[str], flags: int) -> int:
        """By the column of lengths, or of DLCs."""
        if "l" in self._at:
            return _small(tokens[self._at["l"]])
        dlc = _small(tokens[self._at["L"]])
        return LENGTHS[dlc] if flags & FD else min(dlc, 8)


def line_of_columns(names: list[str]) -> Callable[[str], Frame | Other]:
    """The reader of lines that have these columns."""
    return _Columns(names)
