"""Single lines of ASC logs."""

from __future__ import annotations

import re

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

_TIME = re.compile(r"-?\d{1,10}(?:\.\d{1,9})?$")
_NUMERIC = {10: re.compile(r"\d{1,10}[xX]?$"), 16: re.compile(r"[\dA-Fa-f]{1,8}[xX]?$")}
_ID_BEHIND = re.compile(r"\bID = (\d{1,10})(x?)", re.IGNORECASE)
_DIRECTIONS = {"rx": 0, "tx": SENT}

_REQUESTS = "transmit requests"
_EVENTS = "events"
_FLAG_REMOTE = 0x10
_FLAG_REQUEST = 0x80
_FLAG_FD = 0x1000


class AscLines:
    """Reads lines that begin with a time.

    ``base`` is that of identifiers and payloads, 16 or 10; ``has_names`` says that a name stood in
    place of an identifier.
    """

    def __init__(self) -> None:
        self.base = 16
        self.has_names = False

    def read(self, line: str) -> Frame | Other:
        """What a line holds; raises `ValueError` where a frame should be and is none."""
        tokens = line.split()
        if not _TIME.match(tokens[0]):
            return Other("")
        time = float(tokens[0])
        if len(tokens) < 3:
            return Other(_EVENTS, time)
        if tokens[1] == "CANFD":
            return self._fd(time, tokens, line)
        if tokens[1].isdecimal():
            return self._classic(time, tokens, line)
        return Other(_kind(tokens[1]), time)

    def _classic(self, time: float, tokens: list[str], line: str) -> Frame | Other:
        what = tokens[2].lower()
        channel = _channel(tokens[1])
        if what.startswith("errorframe"):
            return Frame(time, 0, EXTENDED | ERROR, channel, 0, b"")
        if len(tokens) < 4 or what in ("j1939tp", "statistic:"):
            return Other(_kind(what), time)
        direction = tokens[3].lower()
        if direction == "txrq":
            return Other(_REQUESTS, time)
        flags = _DIRECTIONS.get(direction)
        if flags is None:
            return Other(_EVENTS, time)
        if len(tokens) < 5:
            raise ValueError("the line ends behind the direction")
        frame_id, extended = self._id(tokens[2], line)
        form = tokens[4].lower()
        if form == "r":
            length = self._number(tokens[5], 2) if _is_dlc(tokens[5:6]) else 0
            remote = flags | extended | REMOTE
            return checked(Frame(time, frame_id, remote, channel, min(length, 8), b""))
        if form != "d":
            raise ValueError("neither data nor a remote frame")
        length = min(self._number(tokens[5] if len(tokens) > 5 else "", 2), 8)
        data = joined_bytes(tokens[6 : 6 + length], self.base)
        return checked(Frame(time, frame_id, flags | extended, channel, length, data))

    def _fd(self, time: float, tokens: list[str], line: str) -> Frame | Other:
        """``time CANFD channel direction id [name] BRS ESI DLC length data time bits flags``."""
        if len(tokens) < 5 or not tokens[2].isdecimal():
            raise ValueError("the line is too short")
        direction = tokens[3].lower()
        if direction == "txrq":
            return Other(_REQUESTS, time)
        flags, channel = _DIRECTIONS[direction], _channel(tokens[2])
        if tokens[4].lower().startswith("errorframe"):
            return Frame(time, 0, EXTENDED | ERROR | FD | flags, channel, 0, b"")
        frame_id, extended = self._id(tokens[4], line)
        rest = tokens[5:] if tokens[5].isdecimal() and len(tokens[5]) == 1 else tokens[6:]
        if rest[0] not in "01" or rest[1] not in "01":
            raise ValueError("no flags of CAN FD")
        length = int(rest[3])
        if not 0 <= length <= LENGTHS[-1]:
            raise ValueError("no frame has so many bytes")
        dlc = int(rest[2], 16)
        data = joined_bytes(rest[4 : 4 + length], self.base)
        said = int(rest[6 + length], 16) if len(rest) > 6 + length else None
        if said is not None and said & _FLAG_REQUEST:
            return Other(_REQUESTS, time)
        is_remote = bool(said & _FLAG_REMOTE) if said is not None else dlc > 0 == length
        is_fd = said is None or bool(said & _FLAG_FD) or length > 8 or "1" in rest[:2]
        flags |= extended | FD * is_fd | REMOTE * is_remote
        flags |= BIT_RATE_SWITCH * (rest[0] == "1") | ERROR_STATE * (rest[1] == "1")
        if is_remote:
            length, data = LENGTHS[dlc] if is_fd else min(dlc, 8), b""
        return checked(Frame(time, frame_id, flags, channel, length, data))

    def _id(self, text: str, line: str) -> tuple[int, int]:
        """The identifier, and `EXTENDED` or 0; a name stands for the one behind the payload."""
        behind = None
        if text.isalpha() or not _NUMERIC[self.base].match(text):
            behind = _ID_BEHIND.search(line)
            self.has_names |= behind is not None
        if behind is not None:
            return int(behind[1]), EXTENDED if behind[2] else 0
        if not _NUMERIC[self.base].match(text):
            raise ValueError("a name, and the line does not say which identifier it has")
        if text[-1] in "xX":
            return int(text[:-1], self.base), EXTENDED
        return int(text, self.base), 0

    def _number(self, text: str, digits: int) -> int:
        if not text.isalnum() or len(text) > digits:
            raise ValueError("no number of bytes")
        return int(text, self.base)


def _channel(text: str) -> int:
    if len(text) > 9:
        raise ValueError("no number of a channel")
    return int(text) - 1


def _is_dlc(tokens: list[str]) -> bool:
    return bool(tokens) and len(tokens[0]) <= 2 and tokens[0].isalnum() and tokens[0] != "ID"


def _kind(word: str) -> str:
    word = word.lower()
    if word in ("start", "comment:"):
        return "comments" if word == "comment:" else ""
    if word == "j1939tp":
        return "lines of the J1939 transport protocol"
    return "statistics" if word == "statistic:" else _EVENTS
