"""What a pack told last, for times that may lie before the chunk."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from swapcan.rules.shared import TOLD_BEFORE
from typedcan.judge.chunk import Chunk
from typedcan.judge.tolerance import Limits
from typedcan.wire.message import Message

_KEPT = 512
"""Frames: cycles that have waited for the pack's totals come two seconds late."""


class History:
    """The latest frames of one message.

    Parameters
    ----------
    limits
        For how long what was told counts.
    message
        Which; it has a period.
    fields, raw
        Those whose physical values, and those whose raw ones are wanted.
    """

    def __init__(
        self,
        limits: Limits,
        message: type[Message],
        *fields: str,
        raw: tuple[str, ...] = (),
    ) -> None:
        self._message = message
        self._in_force = limits.limit(TOLD_BEFORE) * (message.PERIOD or 0.0)
        self.time: NDArray[np.float64] = np.empty(0)
        """Seconds since the log's begin."""
        self.order: NDArray[np.int64] = np.empty(0, np.int64)
        """Numbers in the log."""
        self.values: dict[str, NDArray[np.float64]] = {field: np.empty(0) for field in fields}
        """Physical values by field, NaN where there is none."""
        self.raw: dict[str, NDArray[np.int64]] = {field: np.empty(0, np.int64) for field in raw}
        """Raw values by field."""

    def feed(self, chunk: Chunk) -> None:
        """Add the frames of a chunk; rows found before are other rows now."""
        series = chunk.sound(self._message)
        if not series.fresh:
            return
        own = slice(series.first, None)
        self.time = np.concatenate([self.time[-_KEPT:], series.time[own]])
        self.order = np.concatenate([self.order[-_KEPT:], series.order[own]])
        for field, kept in self.values.items():
            self.values[field] = np.concatenate([kept[-_KEPT:], series.value(field)[own]])
        for field, codes in self.raw.items():
            self.raw[field] = np.concatenate([codes[-_KEPT:], series.raw(field)[own]])

    def at(self, time: NDArray[np.float64]) -> NDArray[np.int64]:
        """The row that was in force at each of these times; -1 where there was none.

        There has to be one row at least.
        """
        sorted_time = np.maximum.accumulate(self.time)
        rows = np.searchsorted(sorted_time, time, side="left").astype(np.int64) - 1
        rows[time - self.time[rows] > self._in_force] = -1
        return rows

    def value_at(self, field: str, rows: NDArray[np.int64]) -> NDArray[np.float64]:
        """The values of a field in some rows, NaN for row -1."""
        return np.where(rows >= 0, self.values[field][rows], np.nan)
