"""What the times in an ASC log count from."""

from __future__ import annotations

from datetime import datetime

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.read.source import Start

Times = NDArray[np.float64]

_NANOSECONDS = 1e9


class AscClock:
    """Makes seconds since the log began of the times in its lines.

    With ``timestamps relative`` each time counts from the line before that has one, whatever it
    holds. The times of a trigger block count from the start of the measurement where they fit
    that: where they do not go backwards, and lie nearer to the block's date than to that start.
    Else they count from the date of the block.
    """

    def __init__(self) -> None:
        self.is_relative = False
        self.header: datetime | None = None
        """The date in the header."""
        self.start: Start | None = None
        self._block: datetime | None = None
        self._offset = 0.0
        self._last = 0.0

    def reckon(self, times: Times, blocks: list[tuple[int, datetime]]) -> Times:
        """The times of lines, NaN where a line has none; ``blocks`` begin at these rows."""
        if not blocks and not self.is_relative and not self._offset and not self._waits:
            return times
        rows = [0, *(row for row, _ in blocks), len(times)]
        dates = [None, *(date for _, date in blocks)]
        parts = []
        for first, last, date in zip(rows, rows[1:], dates, strict=False):
            self._block = date or self._block
            parts.append(self._part(times[first:last]))
        return np.concatenate(parts)

    @property
    def _waits(self) -> bool:
        """Nobody knows yet what times count from."""
        return self._block is not None or (self.start is None and self.header is not None)

    def _part(self, times: Times) -> Times:
        has = ~np.isnan(times)
        if not has.any():
            return times
        before = self._last if self.is_relative else 0.0
        if self.is_relative:  # whole numbers: nothing is lost in the sum
            steps = np.where(has, np.rint(times * _NANOSECONDS), 0.0)
            times = np.where(has, before + steps.cumsum() / _NANOSECONDS, times)
        first = float(times[has][0])
        if self._waits:
            self._begin(first, before)
        if self._offset:
            times = times + self._offset
        self._last = float(times[has][-1])
        if self.is_relative:
            self._offset = 0.0
        return times

    def _begin(self, first: float, before: float) -> None:
        """A block begins, whose first time is this one."""
        date, self._block = self._block, None
        if self.start is None:
            wall = self.header or date
            if date is not None and self.header is not None:
                gap = (date - self.header).total_seconds()
                wall = self.header if 0 <= gap <= 2 * first else date
            if wall is not None:
                self.start = Start(wall, is_utc=False, counted=True)
        elif date is not None:
            gap = (date - self.start.wall).total_seconds()
            fits = first >= self._last and gap <= 2 * first
            self._offset = 0.0 if fits or gap <= 0 else gap - before
