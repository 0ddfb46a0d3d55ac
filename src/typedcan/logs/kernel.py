"""The arithmetic: payload bytes to raw numbers to values, whole stacks of signals per call."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.buffers import Buffers
from typedcan.logs.stacks import UINT8, UINT64, ByteLoad, Stack

FRAMES = 64
"""Frames come in multiples of this, so that rows of any type are a whole number of words."""

_BOOL = np.dtype(np.bool_)

Values = tuple[NDArray[Any], NDArray[np.uint8] | None, NDArray[np.bool_] | None]
"""Values; where codes are reserved also states, and where there is a value."""

_CHUNK = 1 << 15
"""Values scaled at a time, so that they stay in cache from one operation to the next."""


def bytes_of(
    loads: Sequence[ByteLoad], payload: NDArray[np.uint8], buffers: Buffers
) -> NDArray[np.uint8]:
    """The bytes that the signals of a message are made of, a row per byte.

    Parameters
    ----------
    payload
        A row per frame, contiguous, of 8 or 64 bytes; the frames are a multiple of `FRAMES`.
    buffers
        Where the result may be laid.
    """
    last = loads[-1] if loads else ByteLoad(0, 0, 0)
    shape = (last.row + last.stop - last.start, len(payload))
    loaded = buffers.array("bytes", shape, UINT8)
    for load in loads:
        count = load.stop - load.start
        np.copyto(loaded[load.row : load.row + count], payload[:, load.start : load.stop].T)
    return loaded


def values_of(
    stack: Stack,
    payload: NDArray[np.uint8],
    loaded: NDArray[np.uint8],
    buffers: Buffers,
    place: object,
) -> Values:
    """Decode the signals of a stack.

    Parameters
    ----------
    payload
        A row per frame, contiguous, of 8 or 64 bytes; the frames are a multiple of `FRAMES`.
    loaded
        What `bytes_of` made of it.
    buffers, place
        Where the results may be laid.

    Returns
    -------
    Values
        A row per signal, a column per frame.
    """
    lanes = buffers.array((place, "lanes"), (len(stack.names), len(payload)), stack.lane)
    if stack.words:
        _load_words(stack, payload, lanes)
    else:
        _load_bytes(stack, loaded, lanes)
    _cut(stack, lanes)
    if len(stack.high):
        _add_upper(stack, loaded, lanes, buffers)
    raw = _raw(stack, lanes, buffers, place)
    states, valid = None, None
    if stack.codes:
        states = _states(stack, raw, buffers, place)
        valid = buffers.array((place, "valid"), raw.shape, _BOOL)
        np.equal(states, 0, out=valid)
    values = raw if stack.scaling is None else _scaled(stack, raw, buffers, place)
    return values, states, valid


def _load_words(stack: Stack, payload: NDArray[np.uint8], lanes: NDArray[Any]) -> None:
    frames, size = payload.shape
    for word in stack.words:
        source = np.ndarray((frames,), word.dtype, payload, word.byte, (size,))
        np.copyto(lanes[word.row], source)


def _load_bytes(stack: Stack, loaded: NDArray[np.uint8], lanes: NDArray[Any]) -> None:
    # With its default mode, take would go through a copy.
    np.take(loaded, stack.low, axis=0, out=lanes, mode="clip")


def _cut(stack: Stack, lanes: NDArray[Any]) -> None:
    """Shift the bits of each signal to the bottom of its word and drop the others."""
    words = lanes.view(UINT64)
    if len(stack.shifts):
        part = words[: len(stack.shifts)]
        np.right_shift(part, stack.shifts, out=part)
    if len(stack.masks):
        part = words[: len(stack.masks)]
        np.bitwise_and(part, stack.masks, out=part)


def _add_upper(
    stack: Stack, loaded: NDArray[np.uint8], lanes: NDArray[Any], buffers: Buffers
) -> None:
    """Put the bits from a second byte in front."""
    upper = buffers.array("upper", (len(stack.high), lanes.shape[1]), UINT8)
    np.take(loaded, stack.high, axis=0, out=upper, mode="clip")
    words = upper.view(UINT64)
    np.left_shift(words, stack.lifts, out=words)
    np.bitwise_and(words, stack.caps, out=words)
    part = lanes[: len(stack.high)].view(UINT64)
    np.bitwise_or(part, words, out=part)


def _raw(stack: Stack, lanes: NDArray[Any], buffers: Buffers, place: object) -> NDArray[Any]:
    """The raw numbers of words that are cut; the words are overwritten."""
    if len(stack.signs):
        # Flipping the sign bit and taking it away again copies it to all bits above.
        part = lanes[: len(stack.signs)]
        np.bitwise_xor(part, stack.signs, out=part)
        np.subtract(part, stack.signs, out=part)
    if stack.raw.itemsize == stack.lane.itemsize:
        return lanes.view(stack.raw)
    unsigned = np.dtype(f"u{stack.raw.itemsize}")
    narrow = buffers.array((place, "raw"), lanes.shape, unsigned)
    np.copyto(narrow, lanes, casting="unsafe")
    return narrow.view(stack.raw)


def _states(stack: Stack, raw: NDArray[Any], buffers: Buffers, place: object) -> NDArray[np.uint8]:
    states = buffers.array((place, "states"), raw.shape, UINT8)
    for rank, (codes, meanings) in enumerate(zip(stack.codes, stack.states, strict=True)):
        found = np.equal(raw, codes).view(np.uint8)
        if not rank:
            np.multiply(found, meanings, out=states)
        else:
            np.bitwise_or(states, np.multiply(found, meanings, out=found), out=states)
    return states


def _scaled(stack: Stack, raw: NDArray[Any], buffers: Buffers, place: object) -> NDArray[Any]:
    assert stack.scaling is not None
    values = buffers.array((place, "values"), raw.shape, stack.scaling)
    step = max(1, _CHUNK // values.shape[1])
    for row in range(0, len(values), step):
        rows = slice(row, row + step)
        part = values[rows]
        np.copyto(part, raw[rows], casting="unsafe")
        numbers = part if stack.scaling.kind == "f" else part.view(np.uint64)
        if stack.factors is not None:
            np.multiply(numbers, stack.factors[rows], out=numbers)
        if stack.offsets is not None:
            np.add(numbers, stack.offsets[rows], out=numbers)
    return values
