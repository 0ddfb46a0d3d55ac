"""Cycles of cells or probes, put together to columns of a heat map."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.plot.model import GAP_PERIODS, Heat
from typedcan.logs.plot.thin import column_length
from typedcan.logs.transfers import CycleTable, Readings

_COLUMNS = 1024
_MOST = 4 * _COLUMNS


@dataclass(frozen=True, slots=True)
class _Columns:
    """Columns, ascending in time: first and last cycle, and what `Heat` has of them."""

    first: NDArray[np.float64]
    last: NDArray[np.float64]
    low: NDArray[np.float64]
    high: NDArray[np.float64]
    invalid: NDArray[np.bool_]

    def __len__(self) -> int:
        """How many."""
        return len(self.first)


class HeatMap:
    """Takes cycles of one layout on one channel.

    Parameters
    ----------
    readings
        What is measured.
    rows
        Names of the readings.
    origin
        The time stamp that is shown as 0.
    """

    def __init__(self, readings: Readings, rows: tuple[str, ...], origin: float) -> None:
        self._readings = readings
        self._rows = rows
        self._origin = origin
        self._parts: list[_Columns] = []
        self._count = 0

    def add(self, table: CycleTable) -> None:
        """Take some cycles."""
        time = table.timestamp - self._origin
        values = table.values
        self._parts.append(_Columns(time, time, values, values, np.isnan(values)))
        self._count += len(time)
        if self._count > _MOST:
            self._parts = [self._columns()]
            self._count = len(self._parts[0])

    def heat(self, title: str, step: float) -> Heat:
        """The map, of readings that have that smallest step."""
        columns = self._columns()
        period = self._readings.period
        following = np.append(columns.first[1:], np.inf)
        gap = following - columns.last > GAP_PERIODS * period
        ends = np.where(gap, columns.last + period, following)
        return Heat(
            title,
            self._readings.unit,
            step,
            self._rows,
            np.stack([columns.first, ends], axis=1),
            columns.low,
            columns.high,
            columns.invalid,
        )

    def _columns(self) -> _Columns:
        joined = _joined(self._parts)
        if len(joined) <= _COLUMNS:
            return joined
        length = column_length(float(joined.last[-1] - joined.first[0]), _COLUMNS)
        column = np.floor(joined.first / length)
        new = np.ones(len(joined), np.bool_)
        new[1:] = column[1:] != column[:-1]
        starts = np.flatnonzero(new)
        return _Columns(
            joined.first[starts],
            np.maximum.reduceat(joined.last, starts),
            np.fmin.reduceat(joined.low, starts),
            np.fmax.reduceat(joined.high, starts),
            np.logical_or.reduceat(joined.invalid, starts),
        )


def _joined(parts: list[_Columns]) -> _Columns:
    joined = _Columns(
        np.concatenate([part.first for part in parts]),
        np.concatenate([part.last for part in parts]),
        np.concatenate([part.low for part in parts]),
        np.concatenate([part.high for part in parts]),
        np.concatenate([part.invalid for part in parts]),
    )
    if (np.diff(joined.first) >= 0).all():
        return joined
    order = joined.first.argsort(kind="stable")
    return _Columns(
        joined.first[order],
        joined.last[order],
        joined.low[order],
        joined.high[order],
        joined.invalid[order],
    )
