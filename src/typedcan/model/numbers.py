"""How numbers are written, wherever the toolchain writes one."""

from __future__ import annotations

import math
from decimal import Decimal

_DIGITS = 15
"""Digits that every float has; a float has up to 17."""


def number(value: Decimal) -> str:
    """A plain decimal: leading digit, no exponent, no trailing zeros."""
    plain = format(value.normalize(), "f")
    return "0" if plain == "-0" else plain


def without_noise(value: float) -> float:
    """The float with few digits that its arithmetic meant: 0.3 for 0.1 x 3.

    One that is more than its arithmetic's error away from that is as it was.
    """
    short = float(f"{value:.{_DIGITS}g}")
    return short if abs(short - value) <= 2 * math.ulp(value) else value
