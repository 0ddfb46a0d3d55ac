"""CSV logs as python-can and SavvyCAN write them."""

from __future__ import annotations

import base64
import re
from pathlib import Path

from typedcan.logs.read.frame import (
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
from typedcan.logs.read.payload import BASE64
from typedcan.logs.read.source import BLOCK_SIZE
from typedcan.logs.read.text import TextSource
from typedcan.logs.read.text_format import TextFormat

_TIME = re.compile(r"-?\d{1,12}(?:\.\d{0,25})?(?:[eE][+-]\d{1,3})?$")
_ID = re.compile(r"0x[\dA-Fa-f]{1,8}$")
_TRUTH = {"0": False, "1": True}
_NAME_OF_GVRET = re.compile(r"\s*time ?stamp\s*,\s*id\s*,\s*extended\s*,", re.IGNORECASE)


class CsvFormat(TextFormat):
    """``1483389946.197,0x00dadada,1,0,0,6,WzQyLCA5XQ==``."""

    name = "a CSV log of python-can"
    patterns = (
        re.compile(
            rb"(?P<whole>\d{1,10})\.(?P<fraction>\d{1,9}),0x(?P<id>[\dA-Fa-f]{1,8}),"
            rb"[01],[01],[01],\d{1,2},(?P<data>[A-Za-z0-9+/]*)=*\r?\n"
        ),
    )
    payload = BASE64

    def __init__(self) -> None:
        self._begun = False

    def is_header(self, line: bytes) -> bool:
        """The first line, unless it is a frame: python-can appends to a new file without it."""
        begun, self._begun = self._begun, True
        return not begun and not self.patterns[0].fullmatch(line + b"\n")

    def read(self, line: str) -> Frame | Other:
        """``timestamp,arbitration_id,extended,remote,error,dlc,data``."""
        time, name, extended, remote, error, dlc, text = line.strip().split(",")
        if not _TIME.match(time) or not _ID.match(name) or not dlc.isdecimal() or len(dlc) > 2:
            raise ValueError("no number")
        flags = EXTENDED * _TRUTH[extended] | REMOTE * _TRUTH[remote] | ERROR * _TRUTH[error]
        length = int(dlc)
        data = base64.b64decode(text, validate=True)
        flags |= FD * (length > 8 and not flags & REMOTE)
        return checked(Frame(float(time), int(name, 16), flags, None, length, data))


class GvretFormat(TextFormat):
    """``1000000,1882D0F3,true,Rx,0,8,C8,20,4E,20,4E,FF,FF,FF,``, times in microseconds.

    Older versions have no direction. Identifiers above 7FF are of 29 bits whatever ``Extended``
    says: SavvyCAN reads its files so.
    """

    name = "a CSV log of SavvyCAN"

    def __init__(self) -> None:
        self._has_direction = True

    def is_header(self, line: bytes) -> bool:
        """The first line, which names the columns."""
        text = line.decode("latin-1").strip().lstrip("\ufeffï»¿")
        if not _NAME_OF_GVRET.match(text):
            return False
        self._has_direction = ",dir," in text.lower().replace(" ", "")
        return True

    def read(self, line: str) -> Frame | Other:
        """A frame."""
        time, name, extended, *rest = line.strip().split(",")
        flags = 0
        if self._has_direction:
            flags |= {"rx": 0, "tx": SENT}[rest.pop(0).strip().lower()]
        bus, count, *data = rest
        if not time.lstrip("-").isdecimal() or len(time) > 20 or len(bus) > 4 or len(count) > 2:
            raise ValueError("no number")
        frame_id, length = int(name, 16), int(count)
        flags |= EXTENDED if extended.strip().lower() == "true" or frame_id > 0x7FF else 0
        flags |= FD if length > 8 else 0
        payload = joined_bytes([byte.strip().rjust(2, "0") for byte in data[:length]])
        return checked(Frame(int(time) / 1e6, frame_id, flags, int(bus), length, payload))


class CsvSource(TextSource):
    """A CSV log of python-can; see `TextSource`."""

    def __init__(self, path: Path, block_size: int = BLOCK_SIZE) -> None:
        super().__init__(path, block_size, CsvFormat())


class GvretSource(TextSource):
    """A CSV log of SavvyCAN; see `TextSource`."""

    def __init__(self, path: Path, block_size: int = BLOCK_SIZE) -> None:
        super().__init__(path, block_size, GvretFormat())
