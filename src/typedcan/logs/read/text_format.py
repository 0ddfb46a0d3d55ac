"""What a format of text logs says about itself."""

from __future__ import annotations

import math
import re
from abc import ABC, abstractmethod

from typedcan.logs.read.columns import Columns
from typedcan.logs.read.frame import Frame, Other
from typedcan.logs.read.payload import HEX, Payload
from typedcan.logs.read.source import Start

NOT_A_FRAME = (ArithmeticError, LookupError, TypeError, ValueError)
"""What `TextFormat.read` raises on lines that hold no frame."""


class TextFormat(ABC):
    """What is special about one format."""

    name = ""
    """For messages."""

    payload: Payload = HEX
    """How it writes payloads."""

    time_unit = 1
    """What times are divided by to make seconds."""

    origin = 0.0
    """What is added to times, in seconds."""

    start: Start | None = None
    """When the log began, as far as its lines so far say."""

    patterns: tuple[re.Pattern[bytes], ...] = ()
    """Regular lines of frames with their line feed; `Shape` says which groups they have."""

    def is_header(self, line: bytes) -> bool:  # noqa: ARG002
        """Whether the line, the first or behind header lines, belongs to the header.

        Raises one of `NOT_A_FRAME` where it does and is damaged.
        """
        return False

    @abstractmethod
    def read(self, line: str) -> Frame | Other:
        """What a line holds.

        Raises one of `NOT_A_FRAME` where a frame should be and is none.
        """

    def time_of(self, line: bytes) -> float:  # noqa: ARG002
        """The time of a line that makes no sense, where later ones may count from it; else NaN."""
        return math.nan

    def reckon(self, columns: Columns, others: list[tuple[int, Other]]) -> None:  # noqa: ARG002
        """Make of the times as written in some lines those that frames are to have, in place.

        ``others`` is what the lines hold that are no frames, by row.
        """
        if self.origin:
            columns.timestamp += self.origin
