"""Cells and probes as Arrow tables, for conversions: `CellTables` among ``Options.derived``."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np
import pyarrow as pa

from typedcan.logs.arrow import (
    CHANNEL,
    STATE_TYPE,
    STATES,
    TIMESTAMP,
    channel_array,
    float_array,
    from_numpy,
    metadata_of,
)
from typedcan.logs.cells.assembly import CycleCounts
from typedcan.logs.cells.cycles import CellColumns, CycleTable
from typedcan.logs.columns import DecodedBlock, State
from typedcan.logs.protocol import Protocol
from typedcan.logs.shapes import Batch, Shape

_STATE_ARRAY = pa.array(STATES)


class CellTables(Shape):
    """A row per complete cycle, and for each cell or probe a column and one for its states.

    The names of the tables say how many there are, such as ``cells_18x12``; a log has one of them
    unless its packs differ.

    Parameters
    ----------
    protocol
        What the log is decoded by, to physical values.
    assume_seen
        As `CellColumns` has it.
    """

    def __init__(self, protocol: Protocol, *, assume_seen: bool = True) -> None:
        self._protocol = protocol
        self._columns = CellColumns(protocol.readings, assume_seen=assume_seen)
        self._schemas: dict[str, pa.Schema] = {}

    @property
    def schemas(self) -> Mapping[str, pa.Schema]:
        """What all tables begin with, and in full those that occurred."""
        begin = pa.schema([TIMESTAMP, CHANNEL])
        return {**{each.name: begin for each in self._protocol.readings}, **self._schemas}

    @property
    def counts(self) -> dict[str, CycleCounts]:
        """What became of the frames, by ``cells`` and ``probes``."""
        return self._columns.counts

    def take(self, decoded: DecodedBlock) -> Iterator[Batch]:
        """The cycles that are complete with the block; raises `CellsError`."""
        yield from self._batches(self._columns.add(decoded.messages))

    def finish(self) -> Iterator[Batch]:
        """The cycles that waited until the end."""
        yield from self._batches(self._columns.finish())

    def _batches(self, tables: Iterable[CycleTable]) -> Iterator[Batch]:
        for table in tables:
            if table.name not in self._schemas:
                self._schemas[table.name] = cycle_schema(self._protocol, table)
            yield table.name, cycle_batch(table, self._schemas[table.name])


def cycle_schema(protocol: Protocol, table: CycleTable) -> pa.Schema:
    """Time, channel, and for each reading its value, null where there is none, and its state."""
    message = {"message": table.readings.message}
    fields: list[pa.Field[Any]] = [TIMESTAMP, CHANNEL]
    for column, (csc, number) in zip(table.columns, table.positions, strict=True):
        place = {**message, "csc": str(csc), "number": str(number)}
        value = {**place, "unit": table.readings.unit}
        fields.append(pa.field(column, pa.float64(), metadata=value))
        fields.append(pa.field(f"{column}.state", STATE_TYPE, metadata=place))
    return pa.schema(fields, metadata_of(protocol, message))


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
