"""What transfers carry as Arrow tables, for conversions: `TransferTables` among ``derived``."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np
import pyarrow as pa

from typedcan.logs.arrow import (
    CHANNEL,
    STATE_TYPE,
    STATES,
    TIMESTAMP,
    MessageTable,
    channel_array,
    float_array,
    from_numpy,
    metadata_of,
)
from typedcan.logs.columns import DecodedBlock, State
from typedcan.logs.protocol import Protocol
from typedcan.logs.shapes import Batch, Shape
from typedcan.logs.transfers.assembly import CycleCounts
from typedcan.logs.transfers.cycles import CycleTable, ReadingColumns
from typedcan.logs.transfers.values import Complete, ValueColumns
from typedcan.model.transfers.kind import MOST_ITEMS, ProblemKind
from typedcan.model.transfers.parts import Parts, field_of
from typedcan.model.transfers.registry import KINDS

_STATE_ARRAY = pa.array(STATES)

_WIDTHS: Mapping[type, int] = {str: 4, bytes: 2, list: 26}
"""Bytes that an item takes at most where a format has nothing but texts."""

_TYPES: Mapping[type, pa.DataType] = {
    str: pa.string(),
    bytes: pa.binary(),
    list: pa.list_(pa.float64()),
}


class TransferTables(Shape):
    """What takes several frames: a row per complete cycle of readings, text, or set of blocks.

    Readings have for each a column and one for its states. The names of their tables say how many
    there are, such as ``cells_18x12``; a log has one of them unless its packs differ.

    Parameters
    ----------
    protocol
        What the log is decoded by, to physical values.
    assume_seen
        As `ReadingColumns` has it.
    """

    def __init__(self, protocol: Protocol, *, assume_seen: bool = True) -> None:
        self._protocol = protocol
        self._columns = ReadingColumns(protocol.readings, assume_seen=assume_seen)
        self._values = ValueColumns(protocol.values)
        self._tables = {each.transfer.name: ValueTable(protocol, each) for each in protocol.values}
        self._schemas: dict[str, pa.Schema] = {}
        self._readings = {each.name: each.parts.transfer.name for each in protocol.readings}
        self._problems: dict[str, Counter[ProblemKind]] = {}

    @property
    def schemas(self) -> Mapping[str, pa.Schema]:
        """What all tables begin with, and in full those that are known or occurred."""
        begin = pa.schema([TIMESTAMP, CHANNEL])
        known = {table.name: table.schema for table in self._tables.values()}
        return {**{each.name: begin for each in self._protocol.readings}, **known, **self._schemas}

    @property
    def counts(self) -> dict[str, CycleCounts]:
        """What became of the frames of readings, by the names of their tables."""
        return self._columns.counts

    @property
    def problems(self) -> Mapping[str, Counter[ProblemKind]]:
        """What was wrong with transfers, by their names, and how often."""
        found = dict(self._problems)
        for name, counts in self.counts.items():
            found[self._readings[name]] = counts.problems()
        for name, changes in self._columns.mixtures.items():
            if changes:
                found[self._readings[name]]["reading"] = changes
        return {name: kinds for name, kinds in found.items() if kinds.total()}

    @property
    def recognised(self) -> Mapping[str, Counter[str]]:
        """By table, how many cycles came in which reading of the spec."""
        return self._columns.recognised

    def take(self, decoded: DecodedBlock) -> Iterator[Batch]:
        """What is complete with the block; raises `ColumnsError`."""
        yield from self._batches(self._columns.add(decoded.messages))
        found: dict[str, list[Complete]] = {}
        for each in self._values.add(decoded.messages):
            found.setdefault(each.parts.transfer.name, []).append(each)
        for name, complete in found.items():
            table = self._tables[name]
            yield table.name, table.batch(complete)
        self._count()

    def finish(self) -> Iterator[Batch]:
        """The cycles that waited until the end."""
        yield from self._batches(self._columns.finish())
        self._values.finish()
        self._count()

    def _count(self) -> None:
        """Count problems and forget them: a long log may have many."""
        for problem in self._values.problems:
            self._problems.setdefault(problem.transfer, Counter())[problem.kind] += 1
        self._values.problems.clear()

    def _batches(self, tables: Iterable[CycleTable]) -> Iterator[Batch]:
        for table in tables:
            if table.name not in self._schemas:
                self._schemas[table.name] = cycle_schema(self._protocol, table)
            yield table.name, cycle_batch(table, self._schemas[table.name])


class ValueTable:
    """The table of a transfer whose values are texts or data: a row per value.

    Beside time and channel it has the columns of its kind, and one for each detail.
    """

    def __init__(self, protocol: Protocol, parts: Parts) -> None:
        taken = {message.name.casefold() for message in protocol.messages}
        self.name = parts.table
        if self.name.casefold() in taken:  # a table of that message, or a file beside it
            self.name += "_complete"
        self._parts = parts
        self._kind = KINDS[parts.transfer.kind]
        columns = self._kind.columns(parts)
        self._columns = [
            pa.field(name, _TYPES[kind], metadata={"bytes": str(_WIDTHS[kind] * _most(parts))})
            for name, kind in columns.items()
        ]
        self._details: list[tuple[str, pa.Field[Any]]] = []
        names = ["timestamp", "channel", *columns]
        for part in parts.details:
            table = MessageTable(protocol, part.message, signals=(part.signal.name,))
            name = part.signal.name
            while name in names:
                name += "_"
            names.append(name)
            [info] = table.signals
            self._details.append((field_of(part), table.fields(info, name)[0]))
        fields = [TIMESTAMP, CHANNEL, *self._columns, *(each for _, each in self._details)]
        own = {"message": ", ".join(message.name for message in parts.messages)}
        self.schema = pa.schema(fields, metadata_of(protocol, own))

    def batch(self, found: list[Complete]) -> pa.RecordBatch:
        """A row per value."""
        channels = tuple(dict.fromkeys(each.channel for each in found))
        places = np.array([channels.index(each.channel) for each in found], np.int16)
        times = np.array([each.value.at for each in found], np.float64)
        cells = zip(*(self._kind.cells(self._parts, each.value) for each in found), strict=True)
        columns = zip(cells, self._columns, strict=True)
        arrays: list[pa.Array[Any]] = [
            float_array(times),
            channel_array(places, channels),
            *(pa.array(list(held), field.type) for held, field in columns),
            *(self._detail(found, name, field) for name, field in self._details),
        ]
        return pa.RecordBatch.from_arrays(arrays, schema=self.schema)

    @staticmethod
    def _detail(found: list[Complete], name: str, field: pa.Field[Any]) -> pa.Array[Any]:
        held = [each.value.details.get(name) for each in found]
        numbers = [each if isinstance(each, int | float) else None for each in held]
        array: pa.Array[Any] = pa.array(numbers, field.type)
        return array


def _most(parts: Parts) -> int:
    """The most items that a value has."""
    return min(parts.capacity, parts.transfer.count or MOST_ITEMS, MOST_ITEMS)


def cycle_schema(protocol: Protocol, table: CycleTable) -> pa.Schema:
    """Time, channel, and for each reading its value, null where there is none, and its state."""
    message = {"message": table.readings.message}
    about = {**message, "read_as": ", ".join(table.read_as)} if table.read_as else message
    fields: list[pa.Field[Any]] = [TIMESTAMP, CHANNEL]
    for column, (group, number) in zip(table.columns, table.positions, strict=True):
        place = {**message, table.readings.word: str(group), "number": str(number)}
        value = {**place, "unit": table.readings.unit}
        fields.append(pa.field(column, pa.float64(), metadata=value))
        fields.append(pa.field(f"{column}.state", STATE_TYPE, metadata=place))
    return pa.schema(fields, metadata_of(protocol, about))


def cycle_batch(table: CycleTable, schema: pa.Schema) -> pa.RecordBatch:
    """A row per cycle."""
    arrays: list[pa.Array[Any]] = [
        float_array(table.timestamp),
        channel_array(np.zeros(len(table), np.int16), (table.channel,)),
    ]
    sound = not table.state.any()
    for values, state in zip(table.values.T, table.state.T, strict=True):
        valid = None if sound else state == State.VALUE
        arrays.append(from_numpy(np.ascontiguousarray(values), pa.float64(), valid))
        codes = from_numpy(state.astype(np.int8), pa.int8(), None)
        arrays.append(pa.DictionaryArray.from_arrays(codes, _STATE_ARRAY, safe=False))
    return pa.RecordBatch.from_arrays(arrays, schema=schema)
