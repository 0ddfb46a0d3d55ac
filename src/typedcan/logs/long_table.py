"""One long table: a row per signal of each frame, in the order of the frames."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from typedcan.logs.arrow import (
    ADDRESSES,
    CHANNEL,
    STATE_TYPE,
    STATES,
    TIMESTAMP,
    MessageTable,
    channel_array,
    from_numpy,
    metadata_of,
)
from typedcan.logs.columns import (
    Column,
    DecodedBlock,
    MessageColumns,
    SignalInfo,
    addresses_of,
)
from typedcan.logs.labels import LABEL_TYPE, known_codes, places_of
from typedcan.logs.protocol import Protocol
from typedcan.logs.shapes import Batch, Shape

LONG_TABLE = "signals"
"""Name of the table."""

_FRAMES = 1 << 14
"""Frames whose rows are made at a time: a frame has some ten of them."""


class LongTable(Shape):
    """A row per frame and signal: time stamp, channel, message, signal, value, state, label.

    ``value`` is float64 (whole numbers beyond 2^53 are rounded) and null where the code is
    reserved; ``state`` says which of the reserved codes it is, ``label`` what the code is called.
    Signals that a frame of a multiplexed message has not make no row. Where messages are found by
    their PGN, source address, destination and priority are columns too, null for others.

    Parameters
    ----------
    protocol
        What the messages are.
    tables
        The messages and signals that get rows.
    """

    def __init__(self, protocol: Protocol, tables: Mapping[str, MessageTable]) -> None:
        self._signals = [info for table in tables.values() for info in table.signals]
        self._firsts: dict[str, int] = {}
        count = 0
        for name, table in tables.items():
            self._firsts[name] = count
            count += len(table.signals)
        self._messages = pa.array(list(tables), pa.string())
        self._numbers = {name: number for number, name in enumerate(tables)}
        self._names = pa.array([info.name for info in self._signals], pa.string())
        words = dict.fromkeys(word for info in self._signals for word in info.labels.values())
        self._words = pa.array(list(words), pa.string())
        ranks = {word: rank for rank, word in enumerate(words)}
        found_so = [message.name for message in protocol.messages if message.by_pgn]
        self._by_pgn = np.array([name in found_so for name in tables], np.bool_)
        self._labels = [_label_places(info, ranks) for info in self._signals]
        self._schema = pa.schema(
            [
                TIMESTAMP,
                CHANNEL,
                *(each.with_nullable(True) for each in ADDRESSES if self._by_pgn.any()),  # noqa: FBT003
                pa.field("message", LABEL_TYPE),
                pa.field("signal", LABEL_TYPE),
                pa.field("value", pa.float64()),
                pa.field("state", STATE_TYPE),
                pa.field("label", LABEL_TYPE),
            ],
            metadata_of(protocol, {}),
        )

    @property
    def schemas(self) -> Mapping[str, pa.Schema]:
        """The one table."""
        return {LONG_TABLE: self._schema}

    def take(self, decoded: DecodedBlock) -> Iterator[Batch]:
        """The rows of a block."""
        if not decoded.messages:
            return
        block = next(iter(decoded.messages.values())).block
        for start in range(0, len(block), _FRAMES):
            batch = self._rows(decoded, start, min(start + _FRAMES, len(block)))
            if batch is not None:
                yield LONG_TABLE, batch

    def finish(self) -> Iterator[Batch]:
        """Nothing is left."""
        yield from ()

    def _rows(self, decoded: DecodedBlock, start: int, stop: int) -> pa.RecordBatch | None:
        """The rows of the frames from start up to stop."""
        parts = [
            (columns, *np.searchsorted(columns.rows, (start, stop)).tolist())
            for columns in decoded.messages.values()
        ]
        per_frame = np.zeros(stop - start, np.int64)
        for columns, first, last in parts:
            per_frame[columns.rows[first:last] - start] = len(columns.columns)
        ends = np.cumsum(per_frame)
        if not len(ends) or not ends[-1]:
            return None
        rows = _Rows(int(ends[-1]))
        begins = ends - per_frame
        for columns, first, last in parts:
            self._fill(rows, columns, slice(first, last), begins[columns.rows[first:last] - start])
        block = parts[0][0].block
        frames = np.repeat(np.arange(start, stop), per_frame)
        if not rows.there.all():
            frames = frames[rows.there]
            rows = rows.present()
        return pa.RecordBatch.from_arrays(
            [
                pa.array(block.timestamp[frames]),
                channel_array(block.channel[frames], block.channels),
                *self._addresses(block.frame_id[frames], self._by_pgn[rows.message]),
                _words(rows.message, self._messages),
                _words(rows.signal, self._names),
                from_numpy(rows.value, pa.float64(), rows.valid),
                _words(rows.state, pa.array(STATES), pa.int8()),
                _words(rows.label, self._words),
            ],
            schema=self._schema,
        )

    def _addresses(
        self, frame_id: NDArray[np.uint32], by_pgn: NDArray[np.bool_]
    ) -> list[pa.Array[Any]]:
        """What is read in the identifiers of frames that are found by their PGN."""
        if not self._by_pgn.any():
            return []
        return [from_numpy(each, pa.uint8(), by_pgn) for each in addresses_of(frame_id)]

    def _fill(
        self, rows: _Rows, columns: MessageColumns, part: slice, at: NDArray[np.int64]
    ) -> None:
        first = self._firsts[columns.name]
        for place, column in enumerate(columns.columns.values()):
            to = at + place
            values = column.values[part]
            rows.message[to] = self._numbers[columns.name]
            rows.signal[to] = first + place
            rows.value[to] = values
            codes, words = self._labels[first + place]
            if len(codes):
                found = places_of(values.astype(np.float64), codes)
                rows.label[to] = np.where(found < 0, -1, words[found])
            if column.valid is not None:
                _fill_states(rows, column, column.valid[part], part, to)


class _Rows:
    """The columns of some rows; labels are -1 where there is none."""

    def __init__(self, count: int) -> None:
        self.message = np.empty(count, np.int32)
        self.signal = np.empty(count, np.int32)
        self.value = np.empty(count, np.float64)
        self.valid = np.ones(count, np.bool_)
        self.state = np.zeros(count, np.int8)
        self.label = np.full(count, -1, np.int32)
        self.there = np.ones(count, np.bool_)

    def present(self) -> _Rows:
        """The rows of signals that their frame has."""
        rows = _Rows(0)
        for name, values in vars(self).items():
            setattr(rows, name, values[self.there])
        return rows


def _fill_states(
    rows: _Rows,
    column: Column,
    valid: NDArray[np.bool_],
    part: slice,
    to: NDArray[np.int64],
) -> None:
    rows.valid[to] = valid
    rows.label[to[~valid]] = -1
    if column.state is None:
        rows.there[to] = valid
    else:
        state = column.state[part]
        rows.state[to] = state
        rows.there[to] = valid | (state != 0)


def _label_places(
    info: SignalInfo, ranks: Mapping[str, int]
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """The values that have labels, ascending, and where in the dictionary each label is."""
    factor, offset = (info.factor, info.offset) if info.scaled else (1, 0)
    words = {float(code * factor + offset): label for code, label in info.labels.items()}
    codes, labels = known_codes(np.dtype(np.float64), words)
    return codes, np.array([ranks[label] for label in labels], np.int32)


def _words(
    places: NDArray[Any], words: pa.Array[Any], kind: pa.DataType | None = None
) -> pa.Array[Any]:
    valid = places >= 0
    missing = None if valid.all() else valid
    indices = from_numpy(places, pa.int32() if kind is None else kind, missing)
    return pa.DictionaryArray.from_arrays(indices, words, safe=False)
