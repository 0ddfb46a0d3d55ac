"""Numbers that cantools has read to those of the model: scaling, range and start value."""

from __future__ import annotations

import math
from collections.abc import Mapping
from decimal import Decimal
from typing import Any

from cantools.database.can import Signal

from typedcan.model.layout import float_limits


def scaling(signal: Signal) -> tuple[Decimal, Decimal]:
    """Factor and offset; 0 and 0 where one of them is no finite number: nobody can read that."""
    factor, offset = (
        Decimal(repr(number)) for number in (signal.conversion.scale, signal.conversion.offset)
    )
    known = factor.is_finite() and offset.is_finite()
    return (factor, offset) if known else (Decimal(0), Decimal(0))


def start_value(signal: Signal, defined: Mapping[str, Any]) -> int:
    """The raw value; what is no whole number, as floats may have, is cut off.

    ``defined`` has the definitions of attributes, one of which may say what is the default.
    """
    value: object = signal.raw_initial
    if value is None and "GenSigStartValue" in defined:
        value = defined["GenSigStartValue"].default_value
    finite = isinstance(value, int | float) and math.isfinite(value)
    return int(value) if finite and isinstance(value, int | float) else 0


def limits(signal: Signal, factor: Decimal, offset: Decimal) -> tuple[Decimal, Decimal]:
    """Minimum and maximum; what the file leaves open is what the bits can hold."""
    if signal.conversion.is_float:
        low, high = float_limits(signal.length)
    else:
        values = 1 << signal.length
        raw = -(values // 2) if signal.is_signed else 0
        low, high = sorted((raw * factor + offset, (raw + values - 1) * factor + offset))
    if not signal.minimum and not signal.maximum:  # [0|0], however it is written, is none
        return low, high
    return _given(signal.minimum, low), _given(signal.maximum, high)


def _given(limit: float | None, instead: Decimal) -> Decimal:
    """A limit that is given, and not too large for cantools, as of signals of 1600 bits."""
    if limit is None or not Decimal(repr(limit)).is_finite():
        return instead
    return Decimal(repr(limit))
