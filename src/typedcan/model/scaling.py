"""Raw values to physical ones in Python's numbers: they end in the very values of cantools."""

from __future__ import annotations

from decimal import Decimal

from typedcan.model.signal import Signal

EXACT = 1 << 53
"""Whole numbers up to here are floats, and so are their products and sums."""

_FINE = 1 << 49
"""With more steps than this, floats of neighbouring raw values may be one and the same."""


def python_number(value: Decimal) -> float:
    """An integer where no point or exponent is written, as the readers of databases have it."""
    return float(value) if value.as_tuple().exponent else int(value)


def to_physical(signal: Signal) -> tuple[float, float]:
    """Factor and offset in the arithmetic of cantools: integers where both are whole.

    But those of floats, which stay as they are; 1 and 0 change no value at all.
    """
    factor, offset = python_number(signal.factor), python_number(signal.offset)
    if factor == 1 and offset == 0:
        return 1, 0
    if not signal.is_float and factor == int(factor) and offset == int(offset):
        return int(factor), int(offset)
    return factor, offset


def scaling_of(signal: Signal) -> tuple[float, float]:
    """Factor and offset of a measured value: integers where it is whole, else a float by both.

    A whole factor stays a whole number where that rounds once less.
    """
    factor, offset = to_physical(signal)
    if is_whole(signal):
        return factor, offset
    rounds = isinstance(factor, int) and not isinstance(offset, int) and is_fine(signal)
    return factor if rounds else float(factor), float(offset)


def is_exact(signal: Signal) -> bool:
    """Whether floats hold all that whole numbers of the raw values and of their scaling become."""
    low, high = signal.raw_limits
    factor, offset = to_physical(signal)
    return abs(factor) * max(-low, high) + abs(offset) <= EXACT


def is_whole(signal: Signal) -> bool:
    """Whether physical values are whole numbers of which floats do not hold all."""
    factor, offset = to_physical(signal)
    whole = isinstance(factor, int) and isinstance(offset, int)
    return whole and not signal.is_float and not is_exact(signal)


def is_fine(signal: Signal) -> bool:
    """Whether its steps are finer than floats of its size, so that several become one of them."""
    low, high = signal.raw_limits
    ends = (low * signal.factor + signal.offset, high * signal.factor + signal.offset)
    return not signal.is_float and max(map(abs, ends)) > _FINE * abs(signal.factor)
