"""Decoding from Arrow to Arrow: what runs inside Spark, Ray Data, Dask or beside DuckDB."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from typedcan.logs.arrow import (
    TIMESTAMP,
    MessageTable,
    buffer_of,
    channel_array,
    from_numpy,
    message_tables,
    plain_batch,
    plain_schema,
)
from typedcan.logs.checks import Checks
from typedcan.logs.checksums import NONE
from typedcan.logs.columns import MessageColumns
from typedcan.logs.database import protocol_of
from typedcan.logs.decode import Decoder
from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.logs.part import LogPart
from typedcan.logs.plan import Mode
from typedcan.logs.protocol import Protocol
from typedcan.logs.read import BLOCK_SIZE, Damage
from typedcan.logs.selection import select
from typedcan.model.checksums.registry import Given
from typedcan.model.errors import TypedcanError

_FRAME_FIELDS: list[pa.Field[Any]] = [
    TIMESTAMP,
    pa.field("channel", pa.string()),
    pa.field("frame_id", pa.uint32(), nullable=False),
    pa.field("flags", pa.uint8(), nullable=False),
    pa.field("data", pa.binary(), nullable=False),
]
FRAME_SCHEMA = pa.schema(_FRAME_FIELDS)
"""What `frame_batches` gives and `decode_batch` takes; ``flags`` are those of `FrameFlag`."""

_NARROW, _WIDE = 8, 64
_LAST_STANDARD = 0x7FF


class BatchError(TypedcanError, ValueError):
    """A record batch does not hold frames."""


def decode_batch(
    batch: pa.RecordBatch,
    *,
    own: Protocol,
    dbc: Path | str | None = None,
    messages: Sequence[str] = (),
    signals: Sequence[str] = (),
    mode: Mode = Mode.PHYSICAL,
    plain: bool = False,
    keep_faulty: bool = False,
    algorithms: Given = NONE,
) -> dict[str, pa.RecordBatch]:
    """Decode frames. A pure function: the same frames give the same rows, in any process.

    Parameters
    ----------
    batch
        A row per frame. ``frame_id``: any integer type, the bare identifier. ``data``: binary, the
        payload. ``timestamp``: any type, handed on as it is. Optional: ``channel``, any type that
        casts to string; ``flags``, bits of `typedcan.logs.frames.FrameFlag`, or in their place
        ``is_extended``, boolean. Without either, identifiers above 0x7FF are extended, and all
        frames are data frames. Other columns are passed over, as are rows without an identifier
        or payload.
    own
        The protocol where no database is given, and what is known of one made from it.
    dbc
        A DBC file, or another database; None: ``own``.
    messages, signals, mode
        Which, and what the columns hold, as `typedcan.logs.pipeline.Options` has them.
    plain
        Strings in place of dictionaries and signed integers in place of unsigned ones, for engines
        that have neither, such as Spark.
    keep_faulty, algorithms
        As `typedcan.logs.pipeline.Options` has them.

    Returns
    -------
    dict[str, pa.RecordBatch]
        By name of the message, those that occur; a row per frame, columns as `schemas` says.

    Raises
    ------
    BatchError
        A column is missing or has an impossible type or value.
    DbcError, SelectionError, AlgorithmError
        The DBC cannot be read, or has no message, signal or algorithm of such a name.
    """
    protocol, decoder, tables = _prepared(own, dbc, tuple(messages), tuple(signals), mode)
    try:
        frames = _complete(batch)
        block = _block(frames)
    except (pa.ArrowInvalid, pa.ArrowNotImplementedError, pa.ArrowTypeError) as error:
        raise BatchError(f"these are no frames: {error}") from None
    checks = Checks(protocol, keep_faulty=keep_faulty, algorithms=algorithms)
    decoded = checks.take(decoder.decode(block))
    found = {
        name: _batch(tables[name], columns, frames) for name, columns in decoded.messages.items()
    }
    return {name: plain_batch(each) for name, each in found.items()} if plain else found


def schemas(
    *,
    own: Protocol,
    dbc: Path | str | None = None,
    messages: Sequence[str] = (),
    signals: Sequence[str] = (),
    mode: Mode = Mode.PHYSICAL,
    plain: bool = False,
) -> dict[str, pa.Schema]:
    """What `decode_batch` gives for the same arguments, by name of the message.

    ``timestamp`` is float64 here; there it has the type it comes with. Raises as `decode_batch`.
    """
    protocol = protocol_of(None if dbc is None else Path(dbc), own)
    tables = message_tables(protocol, select(protocol, messages, signals), mode)
    found = {name: table.schema for name, table in tables.items()}
    return {name: plain_schema(each) for name, each in found.items()} if plain else found


def frame_batches(path: Path | str, rows: int = BLOCK_SIZE) -> Iterator[pa.RecordBatch]:
    """The frames of a log as record batches of `FRAME_SCHEMA`, in its order.

    Parameters
    ----------
    path
        The log.
    rows
        Frames in a batch.

    Raises
    ------
    LogError
        The log cannot be opened.
    DamagedLogError
        The log is damaged; after all frames before the damage.
    """
    with LogPart(Path(path), rows) as log:
        for block in log:
            yield _frame_batch(block)
        if log.damage is not None:
            raise DamagedLogError(log.damage)


class DamagedLogError(TypedcanError):
    """A log is damaged; ``damage`` says where. All frames before were delivered."""

    def __init__(self, damage: Damage) -> None:
        self.damage = damage
        super().__init__(str(damage))


_Prepared = tuple[Protocol, Decoder, dict[str, MessageTable]]


class _PerThread(threading.local):
    """A decoder is for one thread, and costs more to make than a small batch to decode."""

    def __init__(self) -> None:
        self.prepared: dict[object, _Prepared] = {}


_PER_THREAD = _PerThread()


def _prepared(
    own: Protocol,
    dbc: Path | str | None,
    messages: tuple[str, ...],
    signals: tuple[str, ...],
    mode: Mode,
) -> _Prepared:
    key = (own, dbc, messages, signals, mode)
    if key not in _PER_THREAD.prepared:
        protocol = protocol_of(None if dbc is None else Path(dbc), own)
        wanted = select(protocol, messages, signals)
        decoder = Decoder(protocol.messages, mode=mode, reserved=protocol.reserved, wanted=wanted)
        _PER_THREAD.prepared[key] = protocol, decoder, message_tables(protocol, wanted, mode)
    return _PER_THREAD.prepared[key]


def _complete(batch: pa.RecordBatch) -> pa.RecordBatch:
    """The rows that are frames."""
    for name in ("timestamp", "frame_id", "data"):
        if name not in batch.schema.names:
            raise BatchError(f"there is no column {name!r}; there are {batch.schema.names}")
    needed = [batch.column("frame_id"), batch.column("data")]
    if any(column.null_count for column in needed):
        there = np.logical_and(*(np.asarray(column.is_valid()) for column in needed))
        return batch.filter(pa.array(there))
    return batch


def _block(batch: pa.RecordBatch) -> FrameBlock:
    frame_id = batch.column("frame_id").cast(pa.uint32()).to_numpy()
    length, data = _payloads(batch.column("data").cast(pa.binary()))
    count = len(frame_id)
    return FrameBlock(
        timestamp=np.zeros(count),  # nothing here looks at times
        frame_id=frame_id,
        flags=_flags(batch, frame_id),
        channel=np.zeros(count, np.int16),
        length=length,
        data=data,
        channels=(None,),
    )


def _flags(batch: pa.RecordBatch, frame_id: NDArray[np.uint32]) -> NDArray[np.uint8]:
    names = batch.schema.names
    if "flags" in names:
        return np.asarray(batch.column("flags").cast(pa.uint8()).fill_null(0))
    if "is_extended" in names:
        extended = np.asarray(batch.column("is_extended").cast(pa.bool_()).fill_null(False))  # noqa: FBT003
    else:
        extended = frame_id > _LAST_STANDARD
    return np.where(extended, np.uint8(FrameFlag.EXTENDED), np.uint8(0))


def _payloads(data: Any) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """The lengths of binary values, and their bytes in rows."""
    _, offsets, content = data.buffers()
    ends = np.frombuffer(offsets, np.int32)[data.offset : data.offset + len(data) + 1]
    lengths = np.diff(ends)
    longest = int(lengths.max(initial=0))
    if longest > _WIDE:
        raise BatchError(f"a payload has {longest} bytes, a frame has {_WIDE} at most")
    width = _NARROW if longest <= _NARROW else _WIDE
    flat = np.frombuffer(content or b"", np.uint8)[ends[0] : ends[-1]] if len(data) else None
    if flat is not None and len(flat) == width * len(data):
        rows = flat.reshape(-1, width)
    else:
        rows = np.zeros((len(data), width), np.uint8)
        if flat is not None:
            rows[np.arange(width) < lengths[:, np.newaxis]] = flat
    return lengths.astype(np.uint8), rows


def _batch(table: MessageTable, columns: MessageColumns, frames: pa.RecordBatch) -> pa.RecordBatch:
    """The rows of a message, with times and channels of the frames that came in."""
    rows: Any = pa.array(columns.rows)
    channel: Any
    timestamp = frames.column("timestamp").take(rows)
    if "channel" in frames.schema.names:
        channel = frames.column("channel").take(rows).cast(pa.string()).dictionary_encode()
    else:
        channel = channel_array(columns.channel, columns.block.channels)
    arrays: list[pa.Array[Any]] = [timestamp, channel, *table.signal_arrays(columns)]
    schema = table.schema.set(0, table.schema.field(0).with_type(timestamp.type))
    return pa.RecordBatch.from_arrays(arrays, schema=schema)


def _frame_batch(block: FrameBlock) -> pa.RecordBatch:
    ends = np.zeros(len(block) + 1, np.int32)
    width = block.data.shape[1]
    # A remote frame has a length, but no bytes.
    sizes = np.where(block.flags & FrameFlag.REMOTE, 0, block.length).astype(np.int32)
    np.cumsum(sizes, out=ends[1:])
    content = block.data[np.arange(width) < sizes[:, np.newaxis]]
    data = pa.Array.from_buffers(
        pa.binary(), len(block), [None, buffer_of(ends), buffer_of(content)]
    )
    channel = channel_array(block.channel, block.channels).cast(pa.string())
    arrays: list[pa.Array[Any]] = [
        from_numpy(block.timestamp, pa.float64(), None),
        channel,
        from_numpy(block.frame_id, pa.uint32(), None),
        from_numpy(block.flags, pa.uint8(), None),
        data,
    ]
    return pa.RecordBatch.from_arrays(arrays, schema=FRAME_SCHEMA)
