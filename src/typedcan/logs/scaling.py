"""What a raw value becomes, so that numpy arithmetic ends in the very number cantools gives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from typedcan.model.protocol import Signal
from typedcan.model.scaling import is_exact, to_physical

FLOAT64 = np.dtype(np.float64)
OBJECT = np.dtype(object)


@dataclass(frozen=True, slots=True)
class Scaling:
    """How raw values become those of a column.

    Parameters
    ----------
    dtype
        Of the column; ``object`` holds Python integers that fit no machine integer.
    factor, offset
        To apply, in the arithmetic of ``dtype``; factor None: raw values stay as they are.
    vector
        False where numpy's arithmetic could round otherwise than Python's.
    """

    dtype: np.dtype[Any]
    factor: float | None = None
    offset: float = 0
    vector: bool = True


def raw_dtype(signal: Signal) -> np.dtype[Any]:
    """The smallest type that holds every raw value of the signal."""
    if signal.is_float:
        return np.dtype(f"f{signal.length // 8}")
    low, high = signal.raw_limits
    return integer_dtype(low, high, signed=signal.signed)


def integer_dtype(low: int, high: int, *, signed: bool) -> np.dtype[Any]:
    """The smallest integer type of that kind from low to high, ``object`` where there is none."""
    for size in (1, 2, 4, 8):
        dtype = np.dtype(f"{'i' if signed else 'u'}{size}")
        limits = np.iinfo(dtype)
        if limits.min <= low and high <= limits.max:
            return dtype
    return OBJECT


def scaling_of(signal: Signal) -> Scaling:
    """How raw values of the signal become physical ones."""
    factor, offset = to_physical(signal)
    if factor == 1 and offset == 0:
        # Adding -0 changes no number; adding 0 would make 0 of -0.
        return Scaling(FLOAT64, 1.0, -0.0) if signal.is_float else Scaling(raw_dtype(signal))
    if signal.is_float:
        return Scaling(FLOAT64, float(factor), float(offset))
    low, high = signal.raw_limits
    exact = is_exact(signal)
    if isinstance(factor, int) and isinstance(offset, int):
        return _whole(factor, offset, low, high, exact=exact)
    # Python multiplies two integers without rounding and rounds the sum alone.
    vector = not isinstance(factor, int) or factor == 1 or exact
    return Scaling(FLOAT64, float(factor), float(offset), vector)


def _whole(factor: int, offset: int, low: int, high: int, *, exact: bool) -> Scaling:
    if exact:
        return Scaling(FLOAT64, float(factor), float(offset))
    ends = sorted((low * factor + offset, high * factor + offset))
    dtype = integer_dtype(ends[0], ends[1], signed=ends[0] < 0)
    if dtype == OBJECT:
        return Scaling(OBJECT, vector=False)
    # Products may overflow; modulo 2^64 the sum comes out right all the same.
    return Scaling(np.dtype(f"{dtype.kind}8"), factor % (1 << 64), offset % (1 << 64))
