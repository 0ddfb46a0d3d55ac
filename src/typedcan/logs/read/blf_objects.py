"""The frames among the objects of a BLF log, taken out a column at a time."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.logs.read.blf_layouts import (
    CAN_ERROR,
    CAN_ERROR_EXT,
    CAN_FD_ERROR_64,
    CAN_FD_MESSAGE,
    CAN_FD_MESSAGE_64,
    FRAME_TYPES,
    LAYOUTS,
    Layout,
    kind_of,
)
from typedcan.logs.read.blf_scan import records
from typedcan.logs.read.blocks import NARROW, WIDE, Channels, clear_beyond, joined, rows_of

_BASE = np.dtype(
    {
        "names": ["version", "size", "type"],
        "formats": ["<u2", "<u4", "<u4"],
        "offsets": [6, 8, 12],
        "itemsize": 16,
    }
)
_EXTENDED_ID = 0x8000_0000
_ID_MASK = 0x1FFF_FFFF
_TEN_MICROSECONDS = 1  # any other unit is a nanosecond
_EXACT = 2**53  # whole numbers up to it are exact as float64

_FD_LENGTHS = np.array([0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, *[64] * 241], np.uint8)
"""Bytes by DLC."""

_LONG = {CAN_FD_MESSAGE_64: 40, CAN_FD_ERROR_64: 44}
"""Bytes of the body before a payload of any length."""

_NO_REMOTE, _REQUEST = 0x7F, 2
_REQUESTED = 0x80
"""What says that an object is no frame on the bus, but a request to send one."""

_Bits = tuple[tuple[int, FrameFlag], ...]
_CLASSIC: _Bits = ((0x80, FrameFlag.REMOTE), (0x01, FrameFlag.SENT))
_FD: _Bits = (
    (0x1, FrameFlag.FD),
    (0x2, FrameFlag.BIT_RATE_SWITCH),
    (0x4, FrameFlag.ERROR_STATE),
)
_FD_64: _Bits = (
    (0x0010, FrameFlag.REMOTE),
    (0x1000, FrameFlag.FD),
    (0x2000, FrameFlag.BIT_RATE_SWITCH),
    (0x4000, FrameFlag.ERROR_STATE),
)


def frames(
    data: bytes,
    starts: NDArray[np.int64],
    start_time: float,
    channels: Channels,
    passed: Counter[str],
) -> tuple[FrameBlock | None, int]:
    """The frames among the objects that begin at ``starts``, in their order.

    Parameters
    ----------
    data
        Inflated bytes that hold all of each object.
    starts
        Where objects begin.
    start_time
        Added to the times of the objects, in seconds.
    channels
        The log's channels, continued here.
    passed
        Counts what is no frame on the bus.

    Returns
    -------
    tuple
        The frames, or None where there are none, and how many objects were understood: the next
        one is too short for what it says it is.
    """
    base = records(data, starts, _BASE)
    sizes = base["size"]
    places = []
    understood = len(starts)
    for layout, at in _by_layout(base):
        places.append((layout, at))
        short = at[sizes[at] < layout.record.itemsize]
        understood = min([understood, *short[:1].tolist()])
    _count_others(base["type"][:understood], passed)
    found = []
    for layout, at in places:
        kept = at if understood == len(starts) else at[at < understood]
        begins = starts if len(kept) == len(starts) else starts[kept]
        objects = records(data, begins, layout.record)
        if (on_bus := _on_bus(layout, objects)) is not None:
            passed["transmit requests"] += len(kept) - len(on_bus)
            kept, begins, objects = kept[on_bus], begins[on_bus], objects[on_bus]
        if len(kept):
            found.append((kept, _block(layout, data, begins, objects, channels)))
    if not found:
        return None, understood
    block = found[0][1]
    if len(found) > 1:
        order = np.argsort(np.concatenate([rows for rows, _ in found]), kind="stable")
        block = rows_of(joined([each for _, each in found]), order)
    return replace(block, timestamp=block.timestamp + start_time), understood


def _count_others(types: NDArray[np.uint32], passed: Counter[str]) -> None:
    if len(types) and (types == types[0]).all():
        types, counts = types[:1], np.array([len(types)])
    else:
        types, counts = np.unique(types, return_counts=True)
    for kind, count in zip(types.tolist(), counts.tolist(), strict=True):
        if kind not in FRAME_TYPES:
            passed[kind_of(kind)] += count


def _on_bus(layout: Layout, objects: NDArray[np.void]) -> NDArray[np.int64] | None:
    """Which objects are frames on the bus, and no requests to send one; None where all are."""
    if layout.kind == CAN_FD_MESSAGE_64:
        requests = (objects["direction"] == _REQUEST) | (objects["fd_flags"] & _REQUESTED != 0)
    elif layout.kind in (CAN_ERROR, CAN_ERROR_EXT, CAN_FD_ERROR_64):
        return None
    else:
        flags = objects["flags"]
        if not flags.any():
            return None
        requests = flags & _NO_REMOTE == _REQUEST
    return np.flatnonzero(~requests) if requests.any() else None


def _by_layout(base: NDArray[np.void]) -> Iterator[tuple[Layout, NDArray[np.int64]]]:
    """Which of the objects have a layout that is known, for each such layout."""
    kinds = base["type"].astype(np.uint64) << 16 | base["version"]
    alike = bool((kinds[1:] == kinds[:-1]).all())
    for kind in (kinds[:1] if alike else np.unique(kinds)).tolist():
        layout = LAYOUTS.get((kind >> 16, kind & 0xFFFF))
        if layout is not None:
            yield layout, np.arange(len(kinds)) if alike else np.flatnonzero(kinds == kind)


def _block(
    layout: Layout,
    data: bytes,
    starts: NDArray[np.int64],
    objects: NDArray[np.void],
    channels: Channels,
) -> FrameBlock:
    """The frames of objects, their times since the start of the log."""
    channel = channels.indices(objects["channel"].astype(np.int32) - 1)
    time = _seconds(objects)
    if layout.kind == CAN_ERROR:
        count = len(objects)
        flags = np.full(count, FrameFlag.ERROR | FrameFlag.EXTENDED, np.uint8)
        nothing, payload = np.zeros(count, np.uint8), np.zeros((count, NARROW), np.uint8)
        no_id = np.zeros(count, np.uint32)
        return FrameBlock(time, no_id, flags, channel, nothing, payload, channels.known)
    flags = _flags_of(layout, objects)
    if layout.kind in _LONG:
        payload = _long_payload(layout, data, starts, objects)
    else:
        payload = np.ascontiguousarray(objects["data"])
    length = _lengths(layout, objects, flags, payload)
    frame_id = objects["id"] & np.uint32(_ID_MASK)
    return FrameBlock(time, frame_id, flags, channel, length, payload, channels.known)


def _flags_of(layout: Layout, objects: NDArray[np.void]) -> NDArray[np.uint8]:
    flags = np.where(objects["id"] & _EXTENDED_ID, np.uint8(FrameFlag.EXTENDED), np.uint8(0))
    if layout.kind == CAN_FD_MESSAGE_64:
        flags |= _flags(objects["fd_flags"], _FD_64)
        flags[objects["direction"] != 0] |= np.uint8(FrameFlag.SENT)
    elif layout.kind in (CAN_ERROR_EXT, CAN_FD_ERROR_64):
        flags |= np.uint8(FrameFlag.ERROR)
    else:
        flags |= _flags(objects["flags"], _CLASSIC)
    if layout.kind == CAN_FD_MESSAGE:
        flags |= _flags(objects["fd_flags"], _FD)
    return flags


def _flags(field: NDArray[Any], bits: _Bits) -> NDArray[np.uint8]:
    """The flags that the bits of a field stand for."""
    flags = np.zeros(len(field), np.uint8)
    if field.any():
        for bit, flag in bits:
            flags[field & bit != 0] |= np.uint8(flag)
    return flags


def _lengths(
    layout: Layout, objects: NDArray[np.void], flags: NDArray[np.uint8], payload: NDArray[np.uint8]
) -> NDArray[np.uint8]:
    """Bytes of payload; what is beyond them in ``payload`` is cleared, as for remote frames."""
    fd = layout.kind in (CAN_FD_MESSAGE, *_LONG)
    dlc: NDArray[np.uint8] = objects["dlc"]
    length = np.minimum(objects["valid"] if fd else dlc, np.uint8(WIDE if fd else NARROW))
    remote = (flags & FrameFlag.REMOTE) != 0
    if not remote.any():
        clear_beyond(payload, length)
        return length
    clear_beyond(payload, np.where(remote, np.uint8(0), length))
    return np.where(remote, _FD_LENGTHS[dlc] if fd else dlc, length)


def _long_payload(
    layout: Layout, data: bytes, starts: NDArray[np.int64], objects: NDArray[np.void]
) -> NDArray[np.uint8]:
    """Rows of 64 bytes, zero where an object has fewer than it says are valid."""
    body = layout.record.itemsize
    payload = records(data + bytes(WIDE), starts + body, np.dtype((np.void, WIDE)))
    rows = payload.view(np.uint8).reshape(len(starts), WIDE)
    size = objects["size"].astype(np.int64)
    extra = objects["extra"].astype(np.int64)
    fixed = objects["header_size"].astype(np.int64) + _LONG[layout.kind]
    held = np.where(extra, np.minimum(extra, size), size) - fixed
    clear_beyond(rows, np.clip(held, 0, WIDE).astype(np.uint8))
    return rows


def _seconds(objects: NDArray[np.void]) -> NDArray[np.float64]:
    """Times since the start of the log, rounded once."""
    time: NDArray[np.uint64] = objects["time"]
    coarse = objects["time_unit"] == _TEN_MICROSECONDS
    if time.max() < _EXACT:
        return time / np.where(coarse, 1e5, 1e9)
    units = np.where(coarse, 10**5, 10**9).tolist()
    pairs = zip(time.tolist(), units, strict=True)
    return np.array([value / unit for value, unit in pairs], np.float64)
