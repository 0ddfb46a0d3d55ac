"""One wide table: all signals at the points of a raster, each with the last value before."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from typedcan.logs.arrow import TIMESTAMP, MessageTable, metadata_of
from typedcan.logs.checks import PERIODS, rows_where, taken
from typedcan.logs.columns import Column, DecodedBlock, MessageColumns
from typedcan.logs.protocol import Protocol
from typedcan.logs.shapes import Batch, Shape
from typedcan.model.errors import TypedcanError

RASTER_TABLE = "raster"
"""Name of the table."""

_PAUSE = 600.0
"""After so many seconds without a frame the raster pauses until the next one."""

_ROWS = 1 << 12
"""Rows that are made at a time."""

_LATEST = 1e11
"""Seconds; a time stamp beyond, some 3,000 years, is damaged: the frame is left out."""

_STEP = re.compile(r"\s*(\d+(?:\.\d+)?)\s*(us|ms|s|min)\s*")
_UNITS = {"us": Fraction(1, 10**6), "ms": Fraction(1, 1000), "s": Fraction(1), "min": Fraction(60)}


class RasterError(TypedcanError, ValueError):
    """A raster is none."""


def raster_step(text: str) -> Fraction:
    """Seconds of a raster like ``100ms``, ``0.5s`` or ``1min``.

    Raises
    ------
    RasterError
        It is none of these, or 0.
    """
    found = _STEP.fullmatch(text)
    step = Fraction(found[1]) * _UNITS[found[2]] if found else Fraction(0)
    if not step:
        raise RasterError(f"expected a raster like 100ms, 0.5s or 1min, not {text!r}")
    return step


@dataclass(slots=True)
class _Held:
    """The frames of one message that raster points can still refer to, and for how long."""

    longest: float
    times: NDArray[np.float64] = field(default_factory=lambda: np.empty(0))
    columns: dict[str, Column] = field(default_factory=dict[str, Column])


class Raster(Shape):
    """A row per raster point, a column per signal.

    Points are the multiples of the step, from the first after the log's first frame to the last
    frame. At each point a signal has the value of the last frame at or before it; null before the
    first frame, and where the last one is more than `typedcan.logs.checks.PERIODS` periods back.
    Messages without a period keep their value; of a PGN the last frame counts, whatever its source.
    A column is named like its signal; where two
    messages of the protocol have a signal of one name, or it is that of the times,
    ``message.signal``.

    Parameters
    ----------
    protocol
        What the messages are.
    tables
        The messages and signals that get columns.
    step
        Seconds between two points.
    """

    def __init__(
        self, protocol: Protocol, tables: Mapping[str, MessageTable], step: Fraction
    ) -> None:
        self._tables = tables
        self._step = step
        periods = protocol.periods
        self._held = {
            name: _Held(PERIODS * periods[name] if name in periods else np.inf) for name in tables
        }
        self._sources: dict[str, frozenset[int]] = {}
        self._next: int | None = None
        self._end = -np.inf
        counts = Counter(s.name for message in protocol.messages for s in message.signals)
        fields: list[pa.Field[Any]] = [TIMESTAMP]
        for table in tables.values():
            for info in table.signals:
                alone = counts[info.name] == 1 and info.name != TIMESTAMP.name
                name = info.name if alone else f"{table.name}.{info.name}"
                fields += table.fields(info, name)
        self._schema = pa.schema(fields, metadata_of(protocol, {"raster_s": str(float(step))}))

    @property
    def schemas(self) -> Mapping[str, pa.Schema]:
        """The one table."""
        return {RASTER_TABLE: self._schema}

    @property
    def taken_together(self) -> Mapping[str, frozenset[int]]:
        """The sources of each message that is found by its PGN."""
        return self._sources

    def take(self, decoded: DecodedBlock) -> Iterator[Batch]:
        """The rows up to the last frame of the block."""
        sound = [_with_times(columns) for columns in decoded.messages.values()]
        times = np.sort(np.concatenate([np.empty(0), *(c.timestamp for c in sound)]))
        if not len(times):
            return
        for columns in sound:
            self._hold(columns)
            if columns.by_pgn:
                sources = frozenset(np.unique(columns.addresses[0]).tolist())
                self._sources[columns.name] = self._sources.get(columns.name, sources) | sources
        ends = np.append(self._end, times[:-1])
        pauses = np.flatnonzero(times - ends > _PAUSE).tolist()
        for pause in pauses:
            yield from self._through(float(ends[pause]))
            self._next = self._point(float(times[pause]))
        # What comes at the very time of the last frame may be in the next block.
        yield from self._until(self._point(float(times[-1])))
        self._end = max(self._end, float(times[-1]))
        for name in decoded.messages:
            self._forget(name)

    def finish(self) -> Iterator[Batch]:
        """The row at the last frame, if that is a raster point."""
        yield from self._through(self._end)

    def _point(self, time: float) -> int:
        """The number of the first raster point at or after a time."""
        number = int(np.ceil(time / float(self._step)))
        for near in (number - 1, number, number + 1):
            if self._time(np.array([near]))[0] >= time:
                return near
        return number + 1

    def _time(self, points: NDArray[np.int64]) -> NDArray[np.float64]:
        return points * self._step.numerator / self._step.denominator

    def _through(self, time: float) -> Iterator[Batch]:
        """The rows of the points up to that time, if there was a frame before."""
        if self._next is not None:
            point = self._point(time)
            yield from self._until(point + bool(self._time(np.array([point]))[0] == time))

    def _until(self, stop: int) -> Iterator[Batch]:
        """The rows of the points before that one."""
        while self._next is not None and self._next < stop:
            last = min(self._next + _ROWS, stop)
            points = self._time(np.arange(self._next, last))
            arrays: list[pa.Array[Any]] = [pa.array(points)]
            for name, table in self._tables.items():
                arrays += _at(points, table, self._held[name])
            yield RASTER_TABLE, pa.RecordBatch.from_arrays(arrays, schema=self._schema)
            self._next = last

    def _hold(self, columns: MessageColumns) -> None:
        """Put the frames of a block behind the one that is held."""
        held = self._held[columns.name]
        times = np.append(held.times, columns.timestamp)
        # Frames that come late count from when those before them have come.
        held.times = np.maximum.accumulate(times)
        held.columns = {
            name: _joined(held.columns.get(name), column)
            for name, column in columns.columns.items()
        }

    def _forget(self, name: str) -> None:
        """Keep the last frame only, and those at or after the next point."""
        held = self._held[name]
        if self._next is None:
            return
        first = int(np.searchsorted(held.times, self._time(np.array([self._next]))[0])) - 1
        kept = np.arange(max(first, 0), len(held.times))
        held.times = held.times[kept]
        held.columns = {key: taken(column, kept) for key, column in held.columns.items()}


def _with_times(columns: MessageColumns) -> MessageColumns:
    """The frames that have a usable time stamp."""
    sound = np.abs(columns.timestamp) < _LATEST
    return columns if sound.all() else rows_where(columns, sound)


def _at(points: NDArray[np.float64], table: MessageTable, held: _Held) -> list[pa.Array[Any]]:
    """The arrays of a message's signals at these times."""
    arrays: list[pa.Array[Any]] = []
    if not held.columns:
        for info in table.signals:
            arrays += [pa.nulls(len(points), part.type) for part in table.fields(info, info.name)]
        return arrays
    rows = np.searchsorted(held.times, points, "right") - 1
    there = rows >= 0
    there &= points - held.times[rows] <= held.longest
    for column in held.columns.values():
        here = taken(column, np.maximum(rows, 0))
        here.valid = there if here.valid is None else here.valid & there
        if here.state is not None:
            here.state = here.state * there
        arrays += table.arrays(here)
    return arrays


def _joined(first: Column | None, second: Column) -> Column:
    """The values of one column behind those of another."""
    if first is None:
        return second
    valid = state = None
    if first.valid is not None or second.valid is not None:
        valid = np.concatenate([_valid(first), _valid(second)])
    if first.state is not None and second.state is not None:
        state = np.concatenate([first.state, second.state])
    return Column(second.signal, np.concatenate([first.values, second.values]), valid, state)


def _valid(column: Column) -> NDArray[np.bool_]:
    return np.ones(len(column.values), np.bool_) if column.valid is None else column.valid
