"""Decoded columns as Arrow: schemas with units, labels and citations, and record batches."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from typedcan.logs.columns import Column, MessageColumns, SignalInfo
from typedcan.logs.labels import LABEL_TYPE, label_array
from typedcan.logs.plan import Mode, columns_of
from typedcan.logs.protocol import Protocol
from typedcan.logs.scaling import raw_dtype, scaling_of
from typedcan.logs.selection import Selection
from typedcan.model.naming import unused
from typedcan.model.protocol import Message

Metadata = dict[bytes | str, bytes | str]
"""As Arrow takes it."""

STATES = ("value", "invalid", "abnormal")
"""Words for `typedcan.logs.columns.State`, by number."""

TIMESTAMP = pa.field("timestamp", pa.float64(), nullable=False, metadata={"unit": "s"})
CHANNEL = pa.field("channel", LABEL_TYPE)

ADDRESSES: tuple[pa.Field[Any], ...] = tuple(
    pa.field(name, pa.uint8(), nullable=False)
    for name in ("source_address", "destination", "priority")
)
"""What SAE J1939 reads in the identifiers of messages that are found by their PGN."""

STATE_TYPE = pa.dictionary(pa.int8(), pa.string())
_STATE_ARRAY = pa.array(STATES)


class MessageTable:
    """The table of one message: a row per frame, a column per signal.

    Parameters
    ----------
    protocol, message
        What the message is.
    mode
        What the columns hold.
    signals
        Names of the signals that get a column; None: all.
    """

    def __init__(
        self,
        protocol: Protocol,
        message: Message,
        mode: Mode = Mode.PHYSICAL,
        signals: tuple[str, ...] | None = None,
    ) -> None:
        self.name = message.name
        self.signals = columns_of(message, mode, protocol.reserved, signals)
        """The signals, in the order of the columns."""
        self._types = {
            info.name: _arrow_type(message, info) for info in self.signals if not info.encoded
        }
        self._with_state = {
            info.name
            for info in self.signals
            if info.scaled and protocol.reserved.get((message.name, info.name))
        }
        self._by_pgn = message.by_pgn
        fields = [TIMESTAMP, CHANNEL, *(ADDRESSES if message.by_pgn else ())]
        self.metadata = {info.name: _metadata(protocol, message, info) for info in self.signals}
        """By name of the signal, what is said of its column."""
        # A signal that is called like a column that is there anyway gets another column.
        fixed = {part.name for part in fields}
        taken = fixed | {info.name for info in self.signals}
        self.renamed: dict[str, str] = {}
        """Signals, as ``message.signal``, that have a column of another name, and that name."""
        for info in self.signals:
            name = unused(info.name, taken) if info.name in fixed else info.name
            if name != info.name:
                taken.add(name)
                self.renamed[f"{message.name}.{info.name}"] = name
            fields += self.fields(info, name)
        self.schema = pa.schema(fields, metadata_of(protocol, {"message": message.name}))

    def fields(self, info: SignalInfo, name: str) -> list[pa.Field[Any]]:
        """The column of a signal, by that name, and of its states if it has reserved codes."""
        metadata = self.metadata[info.name]
        column = LABEL_TYPE if info.encoded else self._types[info.name]
        fields: list[pa.Field[Any]] = [pa.field(name, column, metadata=metadata)]
        if info.name in self._with_state:
            signal: Metadata = {"signal": info.name}
            fields.append(pa.field(f"{name}.state", STATE_TYPE, metadata=signal))
        return fields

    def batch(self, columns: MessageColumns) -> pa.RecordBatch:
        """The frames of a block; the columns are copied, so that they outlive the next block."""
        arrays: list[pa.Array[Any]] = [
            float_array(columns.timestamp),
            channel_array(columns.channel, columns.block.channels),
            *self.signal_arrays(columns),
        ]
        return pa.RecordBatch.from_arrays(arrays, schema=self.schema)

    def signal_arrays(self, columns: MessageColumns) -> list[pa.Array[Any]]:
        """The arrays behind time stamp and channel: addresses, if it has them, and signals."""
        arrays: list[pa.Array[Any]] = []
        if self._by_pgn:
            arrays += [from_numpy(each, pa.uint8(), None) for each in columns.addresses]
        for info in self.signals:
            arrays += self.arrays(columns.columns[info.name])
        return arrays

    def arrays(self, column: Column) -> list[pa.Array[Any]]:
        """The arrays of a signal, one for each of its `fields`, copied."""
        name = column.signal.name
        valid = None if column.valid is None or column.valid.all() else column.valid
        if column.signal.encoded:
            first = label_array(column.values, column.signal.labels, valid)
        else:
            first = _value_array(column.values, self._types[name], valid)
        if name not in self._with_state:
            return [first]
        return [first, _state_array(column, valid)]


def message_tables(
    protocol: Protocol, selection: Selection, mode: Mode = Mode.PHYSICAL
) -> dict[str, MessageTable]:
    """The tables of all messages of the selection, by name, in the order of the protocol."""
    return {
        message.name: MessageTable(protocol, message, mode, selection[message.name])
        for message in protocol.messages
        if message.name in selection
    }


def metadata_of(protocol: Protocol, more: Mapping[str, str]) -> Metadata:
    """The metadata of a schema."""
    metadata: Metadata = {"protocol": protocol.name, "swapcan": _version()}
    metadata.update(more.items())
    if protocol.digest:
        metadata["spec_digest"] = protocol.digest
    return metadata


def plain_batch(batch: pa.RecordBatch) -> pa.RecordBatch:
    """The same for engines that have neither dictionaries nor unsigned integers."""
    schema = plain_schema(batch.schema)
    arrays = [column.cast(part.type) for column, part in zip(batch.columns, schema, strict=True)]
    return pa.RecordBatch.from_arrays(arrays, schema=schema)


def plain_schema(schema: pa.Schema) -> pa.Schema:
    """The schema of such a batch."""
    fields = [part.with_type(_plain_type(part.type)) for part in schema]
    metadata: Any = schema.metadata
    return pa.schema(fields, metadata)


def float_array(values: NDArray[np.float64]) -> pa.Array[Any]:
    """An Arrow array on the memory of the values, which must not change any more."""
    return from_numpy(np.ascontiguousarray(values), pa.float64(), None)


def channel_array(
    channel: NDArray[np.int16], channels: tuple[int | str | None, ...]
) -> pa.Array[Any]:
    """The names of channels, null where a log has none."""
    names = pa.array([str(name) for name in channels], pa.string())
    missing = [place for place, name in enumerate(channels) if name is None]
    valid = ~np.isin(channel, missing) if missing else None
    indices = from_numpy(channel.astype(np.int32), pa.int32(), valid)
    return pa.DictionaryArray.from_arrays(indices, names, safe=False)


def from_numpy(
    values: NDArray[Any], kind: pa.DataType, valid: NDArray[np.bool_] | None
) -> pa.Array[Any]:
    """An Arrow array on the memory of contiguous values of that type."""
    bits = None if valid is None else buffer_of(np.packbits(valid, bitorder="little"))
    return pa.Array.from_buffers(kind, len(values), [bits, buffer_of(values)])


def buffer_of(values: NDArray[Any]) -> pa.Buffer:
    """The memory of an array."""
    memory: Any = values  # the stubs do not know that arrays are buffers
    return pa.py_buffer(memory)


def _plain_type(kind: Any) -> pa.DataType:
    plain: pa.DataType = kind.value_type if pa.types.is_dictionary(kind) else kind
    wider: dict[pa.DataType, pa.DataType] = {
        pa.uint8(): pa.int16(),
        pa.uint16(): pa.int32(),
        pa.uint32(): pa.int64(),
        pa.uint64(): pa.decimal128(20, 0),  # no signed type is wider
    }
    return wider.get(plain, plain)


def _value_array(
    values: NDArray[Any], kind: pa.DataType, valid: NDArray[np.bool_] | None
) -> pa.Array[Any]:
    if values.dtype == object:
        present = np.ones(len(values), np.bool_) if valid is None else valid
        pairs = zip(values.tolist(), present.tolist(), strict=True)
        return pa.array([str(value) if there else None for value, there in pairs], kind)
    own = np.array(values, np.float32) if values.dtype == np.float16 else np.array(values)
    return from_numpy(own, kind, valid)


def _state_array(column: Column, valid: NDArray[np.bool_] | None) -> pa.Array[Any]:
    length = len(column.values)
    state = np.zeros(length, np.int8) if column.state is None else column.state.astype(np.int8)
    there = None
    if valid is not None:
        there = valid | (state != 0)
        there = None if there.all() else there
    indices = from_numpy(state, pa.int8(), there)
    return pa.DictionaryArray.from_arrays(indices, _STATE_ARRAY, safe=False)


def _arrow_type(message: Message, info: SignalInfo) -> pa.DataType:
    """Whole numbers that 64 bits do not hold become digits; no other type holds them all."""
    signal = message.signal(info.name)
    dtype = scaling_of(signal).dtype if info.scaled else raw_dtype(signal)
    if dtype.kind == "O":
        return pa.string()
    return pa.from_numpy_dtype(np.dtype(np.float32) if dtype == np.float16 else dtype)


def _metadata(protocol: Protocol, message: Message, info: SignalInfo) -> Metadata:
    metadata: Metadata = {
        "signal": info.name,
        "message": message.name,
        "length": str(message.signal(info.name).length),
        "unit": info.unit,
        "factor": repr(info.factor),
        "offset": repr(info.offset),
        "reference": protocol.references.get((message.name, info.name), ""),
    }
    if info.labels:
        metadata["labels"] = json.dumps(
            {str(code): label for code, label in info.labels.items()}, ensure_ascii=False
        )
    return {key: value for key, value in metadata.items() if value}


@cache
def _version() -> str:
    try:
        return version("swapcan")
    except PackageNotFoundError:
        return "unknown"
