"""Which values of a signal can be sent."""

from __future__ import annotations

import math

from typedcan.model.kinds import Kind
from typedcan.model.scaling import is_whole, scaling_of
from typedcan.model.signal import Signal


def sending_limits(signal: Signal, kind: Kind) -> tuple[float, float]:
    """What can be sent: physical values, of fields with codes raw ones."""
    if kind is Kind.FLOAT:
        return float(signal.minimum), float(signal.maximum)
    low, high = _sendable(signal, kind)
    if kind is Kind.PHYSICAL and is_whole(signal):
        factor, offset = scaling_of(signal)
        least, most = sorted((low * factor + offset, high * factor + offset))
        return least, most
    return _physical_limits(signal, low, high) if kind is Kind.PHYSICAL else (low, high)


def _sendable(signal: Signal, kind: Kind) -> tuple[int, int]:
    """The raw values of the range and, where they make the field, of the codes; if they fit."""
    (low, high), (least, most) = signal.sendable, signal.raw_limits
    if kind is Kind.LABELLED and signal.value_table:
        codes = [code.value for code in signal.value_table.codes]
        low, high = max(min(low, *codes), least), min(max(high, *codes), most)
    return low, high


def _physical_limits(signal: Signal, low: int, high: int) -> tuple[float, float]:
    """The physical values of the raw ends; those of over 53 bits, rounded towards each other."""
    factor, offset = scaling_of(signal)
    # In the arithmetic of the decoder, so that limits hold to the last bit.
    ends = sorted(raw * factor + offset for raw in (low, high))
    middle = sum(ends) / 2

    def inwards(value: float) -> float:
        while not low <= round((value - offset) / factor) <= high and value != middle:
            value = math.nextafter(value, middle)
        return value

    return inwards(ends[0]), inwards(ends[1])
