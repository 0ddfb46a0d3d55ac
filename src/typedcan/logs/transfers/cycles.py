"""Blocks of decoded messages to complete cycles of cells and probes."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.columns import Column, MessageColumns
from typedcan.logs.transfers.assembly import CycleCounts
from typedcan.logs.transfers.readings import ColumnsError, Readings, frames_of
from typedcan.logs.transfers.stream import Cycles, Layout, Stream

Channel = int | str | None

Totals = tuple[int | None, ...]
"""How many groups and readings there are, as far as signals tell; None where it is no number."""


@dataclass(frozen=True, slots=True)
class CycleTable:
    """Complete cycles of one layout on one channel, a row each; n rows, k columns.

    Parameters
    ----------
    name
        Of the table, by its layout: ``cells_18x12`` has 18 groups of 12 cells, ``cells_2x12_1x8``
        two of 12 and one of 8, in this order.
    readings
        What is measured.
    channel
        As python-can gives it.
    positions
        Group and number of each column, ascending.
    timestamp
        Seconds, of the last frame of each cycle.
    values
        Shape (n, k), NaN where there is none.
    state
        `typedcan.logs.columns.State` of each value, shape (n, k).
    read_as
        The readings of the spec in which they came, where it has several and frames tell.
    """

    name: str
    readings: Readings
    channel: Channel
    positions: tuple[tuple[int, int], ...]
    timestamp: NDArray[np.float64]
    values: NDArray[np.float64]
    state: NDArray[np.uint8]
    read_as: tuple[str, ...] = ()

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of the columns."""
        return tuple(self.readings.column(*position) for position in self.positions)

    def __len__(self) -> int:
        """How many cycles."""
        return len(self.timestamp)


class ReadingColumns:
    """Takes the decoded blocks of one log in their order; the package says by what rules.

    Parameters
    ----------
    readings
        What to put together.
    assume_seen
        Whether, as long as the log has no totals, a cycle has what was seen in the first seconds.
    recognise
        Whether to read the frames as they tell, where the spec has several readings; else as it
        usually does.
    """

    def __init__(
        self,
        readings: Iterable[Readings],
        *,
        assume_seen: bool = True,
        recognise: bool = True,
    ) -> None:
        self._readings = tuple(readings)
        self._assume_seen = assume_seen
        self._recognise = recognise
        self._streams: dict[tuple[str, Channel], Stream] = {}
        self._totals: dict[tuple[str, Channel], Totals] = {}
        self._end = -math.inf

    def add(self, messages: Mapping[str, MessageColumns]) -> list[CycleTable]:
        """The cycles that are complete with this block.

        Parameters
        ----------
        messages
            The block's columns by name of the message, of physical values.

        Raises
        ------
        ColumnsError
            A signal was not decoded, or to raw values.
        """
        tables: list[CycleTable] = []
        for readings in self._readings:
            own, totals = messages.get(readings.message), messages.get(readings.totals)
            for channel in channels_of(own, totals):
                stream = self._stream(readings, channel)
                changes = self._changes(readings, channel, totals)
                cycles = self._take(stream, readings, channel, own, changes)
                tables += self._tables(readings, channel, cycles)
        for columns in messages.values():
            self._end = max(self._end, float(columns.block.timestamp.max(initial=-math.inf)))
        return tables

    def finish(self) -> list[CycleTable]:
        """The cycles that waited for what a cycle has, at the end of the log."""
        tables: list[CycleTable] = []
        for readings in self._readings:
            for (name, channel), stream in self._streams.items():
                if name == readings.name:
                    tables += self._tables(readings, channel, stream.finish(self._end))
        return tables

    @property
    def counts(self) -> dict[str, CycleCounts]:
        """What became of the frames, by name of the readings."""
        counts = {readings.name: CycleCounts() for readings in self._readings}
        for (name, _), stream in self._streams.items():
            counts[name].add(stream.counts)
        return counts

    @property
    def recognised(self) -> dict[str, Counter[str]]:
        """By name of the readings, the cycles that came in each reading of the spec."""
        found: dict[str, Counter[str]] = {}
        for (name, _), stream in self._streams.items():
            found.setdefault(name, Counter()).update(stream.recognised.used)
        return {name: used for name, used in found.items() if used}

    @property
    def mixtures(self) -> dict[str, int]:
        """By name of the readings, how often cycles came in another reading than before."""
        found: Counter[str] = Counter()
        for (name, _), stream in self._streams.items():
            found[name] += stream.recognised.mixtures
        return dict(found)

    def _stream(self, readings: Readings, channel: Channel) -> Stream:
        key = readings.name, channel
        if key not in self._streams:
            self._streams[key] = Stream(
                readings, assume_seen=self._assume_seen, recognise=self._recognise
            )
        return self._streams[key]

    def _changes(
        self, readings: Readings, channel: Channel, columns: MessageColumns | None
    ) -> list[tuple[int, float, Totals]]:
        """Where in the block the totals change, and when."""
        if columns is None or not readings.total_signals:
            return []
        for name in readings.total_signals:
            if name not in columns.columns:
                raise ColumnsError(f"{readings.name} need the totals: decode {name}")
        own = on_channel(columns, channel)
        values = np.stack(
            [_whole_numbers(columns.columns[name], own) for name in readings.total_signals]
        )
        new = np.ones(values.shape[1], np.bool_)
        new[1:] = (values[:, 1:] != values[:, :-1]).any(axis=0)
        rows, times = columns.rows[own], columns.timestamp[own]
        changes: list[tuple[int, float, Totals]] = []
        for at in np.flatnonzero(new):
            totals = tuple(None if each < 0 else int(each) for each in values[:, at])
            if self._totals.get((readings.name, channel)) != totals:
                self._totals[readings.name, channel] = totals
                changes.append((int(rows[at]), float(times[at]), totals))
        return changes

    @staticmethod
    def _take(
        stream: Stream,
        readings: Readings,
        channel: Channel,
        columns: MessageColumns | None,
        changes: list[tuple[int, float, Totals]],
    ) -> list[Cycles]:
        """Frames and totals in the order in which they came."""
        own = slice(0) if columns is None else on_channel(columns, channel)
        rows = np.empty(0, np.int64) if columns is None else columns.rows[own]
        if columns is not None and len(rows):
            stream.hold(frames_of(readings, columns, own))
        cycles: list[Cycles] = []
        taken = 0
        for row, at, totals in changes:
            before = int(np.searchsorted(rows, row))
            cycles += stream.take(before - taken)
            taken = before
            cycles += stream.set_totals(totals, at)
        return cycles + stream.take(len(rows) - taken)

    @staticmethod
    def _tables(readings: Readings, channel: Channel, cycles: list[Cycles]) -> list[CycleTable]:
        first = readings.parts.transfer.first_group - 1
        return [
            CycleTable(
                _name(readings, each.layout),
                readings,
                channel,
                tuple((g + first, n) for g, count in each.layout for n in range(1, count + 1)),
                each.timestamp,
                each.values,
                each.state,
                each.read_as,
            )
            for each in cycles
        ]


def _name(readings: Readings, layout: Layout) -> str:
    """No two layouts have the same."""
    counts = dict(layout)
    each = [counts.get(group, 0) for group in range(1, max(counts, default=0) + 1)]
    runs = [f"{len(list(run))}x{count}" for count, run in groupby(each)]
    return "_".join([readings.name, *runs])


def _whole_numbers(column: Column, own: slice | NDArray[np.int64]) -> NDArray[np.int64]:
    """The whole numbers that a signal holds, -1 where it holds none."""
    values = column.values[own].astype(np.int64)
    if column.valid is not None:
        values[~column.valid[own]] = -1
    return values


def channels_of(*messages: MessageColumns | None) -> list[Channel]:
    """The channels that occur, in their order."""
    found: dict[Channel, None] = {}
    for columns in messages:
        if columns is not None:
            numbers = np.unique(columns.channel).tolist()
            found.update(dict.fromkeys(columns.block.channels[number] for number in numbers))
    return list(found)


def on_channel(columns: MessageColumns, channel: Channel) -> slice | NDArray[np.int64]:
    """The rows of a message that came on a channel."""
    if channel not in columns.block.channels:
        return slice(0)
    own = columns.channel == columns.block.channels.index(channel)
    return slice(None) if own.all() else np.flatnonzero(own)
