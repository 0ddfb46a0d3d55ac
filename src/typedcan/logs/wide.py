"""Signals that no machine word holds: decoded one by one, with Python's integers."""

from __future__ import annotations

import struct
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.columns import State
from typedcan.logs.kernel import Values
from typedcan.model.layout import first_bit
from typedcan.model.protocol import ByteOrder, Signal


@dataclass(frozen=True, slots=True)
class Wide:
    """A signal over more than eight bytes, or of a scaling that only Python's numbers get right.

    Parameters
    ----------
    name
        What its values are called.
    signal
        As in the database.
    length
        Bytes of the message.
    dtype
        Of the column.
    scaling
        Factor and offset to physical values; None: the column holds raw values.
    reserved
        Raw codes that are no value.
    """

    name: str
    signal: Signal
    length: int
    dtype: np.dtype[Any]
    scaling: tuple[float, float] | None
    reserved: Mapping[int, State]


def wide_values(wide: Wide, payload: NDArray[np.uint8]) -> Values:
    """The values of the signal, one per row; and states, where codes are reserved."""
    raw = [_raw(wide, row.tobytes()) for row in payload[:, : wide.length]]
    values = np.empty(len(raw), wide.dtype)
    if wide.scaling is None or wide.scaling == (1, 0):
        values[:] = raw
    else:
        factor, offset = wide.scaling
        values[:] = [value * factor + offset for value in raw]
    if not wide.reserved:
        return values, None, None
    states = np.array([wide.reserved.get(value, State.VALUE) for value in raw], np.uint8)
    return values, states, states == State.VALUE


def _raw(wide: Wide, data: bytes) -> Any:
    signal = wide.signal
    if signal.byte_order is ByteOrder.MOTOROLA:
        below = 8 * wide.length - first_bit(signal) - signal.length
        word = int.from_bytes(data, "big") >> below
    else:
        word = int.from_bytes(data, "little") >> signal.start
    word &= (1 << signal.length) - 1
    if signal.is_float:
        size = signal.length // 8
        letter = {2: "e", 4: "f", 8: "d"}[size]
        return struct.unpack(f"<{letter}", word.to_bytes(size, "little"))[0]
    if signal.signed and word >> signal.length - 1:
        word -= 1 << signal.length
    return word
