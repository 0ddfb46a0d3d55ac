"""Numbers that cantools has read to those of the model: scaling, range and start value."""

from __future__ import annotations

import math
from collections.abc import Mapping
from decimal import Decimal
from typing import Any

from cantools.database.can import Signal

from typedcan.model.errors import Location, ReadError
from typedcan.model.layout import float_limits


def scaling(signal: Signal, where: Location) -> tuple[Decimal, Decimal]:
    """Factor and offset; raises `ReadError` for what is no finite number, and for a factor of 0."""
    factor = _number(signal.conversion.scale, signal, where)
    if not factor:
        raise ReadError(f"{where}: {signal.name}: its factor is 0")
    return factor, _number(signal.conversion.offset, signal, where)


def start_value(signal: Signal, defined: Mapping[str, Any]) -> int:
    """The raw value; what is no whole number, as floats may have, is cut off.

    ``defined`` has the definitions of attributes, one of which may say what is the default.
    """
    value: object = signal.raw_initial
    if value is None and "GenSigStartValue" in defined:
        value = defined["GenSigStartValue"].default_value
    finite = isinstance(value, int | float) and math.isfinite(value)
    return int(value) if finite and isinstance(value, int | float) else 0


def _number(value: float, signal: Signal, where: Location) -> Decimal:
    number = Decimal(repr(value))
    if not number.is_finite():
        raise ReadError(f"{where}: {signal.name}: {value} is no finite number")
    return number


def limits(
    signal: Signal, factor: Decimal, offset: Decimal, where: Location
) -> tuple[Decimal, Decimal]:
    """Minimum and maximum; what the file leaves open is what the bits can hold.

    Raises `ReadError` for what is no finite number.
    """
    if signal.conversion.is_float:
        low, high = float_limits(signal.length)
    else:
        values = 1 << signal.length
        raw = -(values // 2) if signal.is_signed else 0
        low, high = sorted((raw * factor + offset, (raw + values - 1) * factor + offset))
    if not signal.minimum and not signal.maximum:  # [0|0], however it is written, is none
        return low, high
    return (
        low if _is_open(signal.minimum) else _number(signal.minimum or 0, signal, where),
        high if _is_open(signal.maximum) else _number(signal.maximum or 0, signal, where),
    )


def _is_open(limit: float | None) -> bool:
    """Whether a limit is not given, or too large for cantools, as of signals of 1600 bits."""
    return limit is None or abs(limit) == math.inf
