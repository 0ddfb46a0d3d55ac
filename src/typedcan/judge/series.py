"""The frames of one message as columns, from one chunk of a log to the next."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.columns import MessageColumns
from typedcan.model.protocol import Signal
from typedcan.wire.message import Message

_INT64 = np.iinfo(np.int64)


@dataclass(frozen=True, slots=True)
class Before:
    """The last frame of a message in what was judged before.

    Seconds since the log's begin, number in the log, raw values by field, bytes.
    """

    time: float
    order: int
    raw: Mapping[str, float]
    payload: NDArray[np.uint8]


class Series:
    """Frames of one message in the log's order, n rows: first one of before, where there is one.

    What it gives holds as long as its chunk, and is not to be changed.

    Parameters
    ----------
    message
        Which message.
    time
        float64, seconds since the log's begin.
    order
        int64, number of the frame in the log, from 0.
    lasts
        Seconds for which what a frame said counts, as `LAST_KNOWN` has it.
    first
        The first new row: 1 where row 0 is the last frame of the chunk before, else 0.
    """

    def __init__(
        self,
        message: type[Message],
        columns: MessageColumns | None,
        before: Before | None,
        begin: float,
        first_order: int,
        lasts: float = math.inf,
    ) -> None:
        self.message = message
        self.lasts = lasts
        self.first = 0 if before is None else 1
        self._columns = columns
        self._before = before
        self._cache: dict[str, NDArray[Any]] = {}
        time = np.empty(0) if columns is None else columns.timestamp - begin
        order = np.empty(0, np.int64) if columns is None else columns.rows + first_order
        self.time: NDArray[np.float64] = _behind(before.time if before else None, time)
        self.order: NDArray[np.int64] = _behind(before.order if before else None, order)

    def __len__(self) -> int:
        """How many rows, the one of before included."""
        return len(self.time)

    @property
    def fresh(self) -> int:
        """How many rows are new."""
        return len(self.time) - self.first

    def raw(self, field: str) -> NDArray[Any]:
        """The raw values of a field, named as in the message class.

        They are int64, float64 for a float, and Python's integers where int64 does not hold all.
        """
        if field not in self._cache:
            own = self._new(field).astype(_dtype(self.message.FIELDS[field].signal))
            before = None if self._before is None else self._before.raw[field]
            self._cache[field] = _behind(before, own)
        return self._cache[field]

    def new_raw(self, field: str) -> NDArray[Any]:
        """The raw values of the new rows, in the smallest integer type: beware of overflow."""
        return self._new(field)

    def value(self, field: str) -> NDArray[np.float64]:
        """The physical values of a field, NaN where the code says that there is none."""
        key = f"={field}"
        if key not in self._cache:
            part = self.message.FIELDS[field]
            raw = self.raw(field)
            values = (raw * part.factor + part.offset).astype(np.float64)
            for code in part.states:
                values[raw == code] = np.nan
            self._cache[key] = values
        return self._cache[key]

    @cached_property
    def payload(self) -> NDArray[np.uint8]:
        """The bytes, shape (n, 8)."""
        length = self.message.LENGTH
        own = np.empty((0, length), np.uint8)
        if self._columns is not None:
            own = self._columns.block.data[self._columns.rows, :length]
        if self._before is None:
            return own
        return np.concatenate([self._before.payload[None, :], own])

    def last(self) -> Before | None:
        """The last row, for the next chunk."""
        if not self.fresh:
            return self._before
        return Before(
            float(self.time[-1]),
            int(self.order[-1]),
            {field: self._new(field)[-1:].tolist()[0] for field in self.message.FIELDS},
            self.payload[-1].copy(),
        )

    def _new(self, field: str) -> NDArray[Any]:
        if self._columns is None:
            return np.empty(0, np.int64)
        return self._columns.columns[self.message.FIELDS[field].dbc_name].values


def latest(of: Series, at: Series) -> NDArray[np.int64]:
    """For each row of ``at`` the row of ``of`` that came last before it; -1 where there is none."""
    return np.searchsorted(of.order, at.order, side="left").astype(np.int64) - 1


def _dtype(signal: Signal) -> type[Any]:
    if signal.is_float:
        return np.float64
    least, most = signal.raw_limits
    return np.int64 if _INT64.min <= least and most <= _INT64.max else object


def _behind(before: float | None, own: NDArray[Any]) -> NDArray[Any]:
    return own if before is None else np.concatenate([np.array([before], own.dtype), own])
