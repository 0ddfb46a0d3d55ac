"""How numbers are written, wherever the toolchain writes one."""

from __future__ import annotations

from decimal import Decimal


def number(value: Decimal) -> str:
    """A plain decimal: leading digit, no exponent, no trailing zeros."""
    plain = format(value.normalize(), "f")
    return "0" if plain == "-0" else plain
