"""candump logs (.log), as `candump -l` of can-utils and python-can write them."""

from __future__ import annotations

import io
import re
from pathlib import Path

import can

from typedcan.logs.read.one_by_one import OneByOne
from typedcan.logs.read.payload import HEX
from typedcan.logs.read.source import BLOCK_SIZE
from typedcan.logs.read.text import TextSource

_ERROR_FRAME = 0x20000000
_LARGEST_ID = 0xFFFFFFFF  # with the flags of socketcan


class CandumpFormat:
    """``(1436509052.249713) vcan0 123#DEADBEEF``, with `` R`` or `` T`` behind it or without."""

    name = "a candump log"
    pattern = re.compile(
        rb"\((?P<whole>\d{1,10})\.(?P<fraction>\d{1,9})\) \S+ "
        rb"(?P<id>[\dA-Fa-f]{1,8})#(?:#\d)?(?P<data>(?:[\dA-Fa-f]{2})*)(?: [RTrt])?\r?\n"
    )
    payload = HEX
    time_unit = 1
    origin = 0.0

    def __init__(self) -> None:
        self.warnings: list[str] = []
        self.lines = OneByOne(can.CanutilsLogReader(io.StringIO()))

    def is_header(self, line: bytes) -> bool:  # noqa: ARG002
        """There is none."""
        return False

    def read(self, line: str) -> can.Message | None:
        """As python-can; but any line with the flag of error frames holds one, whatever class."""
        frame = self.lines.read(line)
        if frame is not None:
            frame_id = int(line.split()[2].partition("#")[0], 16)
            if frame_id > _LARGEST_ID:
                raise ValueError("the identifier has more than 32 bits")
            frame.is_error_frame = bool(frame_id & _ERROR_FRAME)
        return frame


class CandumpSource(TextSource):
    """A candump log; see `TextSource`."""

    def __init__(self, path: Path, block_size: int = BLOCK_SIZE) -> None:
        super().__init__(path, block_size, CandumpFormat())
