"""Plain Python numbers of what is given to a field, and its text for errors.

Nothing here raises, whatever is given and whatever its own methods raise.
"""

from __future__ import annotations

import math
import operator
import reprlib
from collections.abc import Callable
from decimal import Decimal
from enum import Enum
from fractions import Fraction
from numbers import Integral, Rational, Real
from typing import TypeVar

_T = TypeVar("_T")
_LONGEST_TEXT = 60
_LARGEST_SHOWN = 10**40
_MOST_DIGITS = 100
"""No signal holds a number of more; the int of a Decimal such as 1E+999999999 fills the memory."""

_LONG_ONES = (str, list, tuple, dict, set, frozenset)
_REPR = reprlib.Repr()
_REPR.maxlevel = 2
_REPR.maxstring = _REPR.maxother = _LONGEST_TEXT


def shown(value: object) -> str:
    """A value in one short line of printable characters."""
    try:
        return _cut(_text(value))
    except Exception:  # noqa: BLE001 - that a value has no text is no reason to raise another error
        return _cut("".join(("a ", type.__dict__["__name__"].__get__(type(value)))))


def _text(value: object) -> str:
    if isinstance(value, Enum):
        return f"{type(value).__name__}.{value.name}"
    if isinstance(value, int) and abs(value) >= _LARGEST_SHOWN:
        # Python refuses to write out over 4300 digits, and nobody would read them.
        return f"a number of about {int(value.bit_length() * math.log10(2))} digits"
    return _REPR.repr(value) if type(value) in _LONG_ONES else repr(value)


def _cut(text: str) -> str:
    """One line of a text, what cannot be printed escaped and what is too long left out."""
    start = str.__str__(text)[: _LONGEST_TEXT + 1]
    safe = "".join(
        each if each.isprintable() else each.encode("unicode_escape").decode() for each in start
    )
    return safe if len(safe) <= _LONGEST_TEXT else f"{safe[: _LONGEST_TEXT - 3]}..."


def integer(value: object) -> int | None:
    """The int that an int or an integer of numpy's is; None for all else, bool and enums too."""
    return _tried(_integer, value)


def whole_number(value: object) -> int | None:
    """As `integer`, but a Decimal without a fraction is one too."""
    return _tried(_whole_number, value)


def real_number(value: object) -> float | None:
    """The float nearest to a real number of any class.

    None for all else, bool and enums too, and for what is not finite or too large for a float.
    """
    number = _tried(_real_number, value)
    return number if number is not None and math.isfinite(number) else None


def exact_number(value: object) -> Fraction:
    """What a real number of any class is, exactly, or else the float nearest to it.

    Raises `ValueError` where `real_number` gives None.
    """
    if exact := _tried(_exact_number, value):
        return exact
    number = real_number(value)
    if number is None:
        raise ValueError(f"{shown(value)} is no number")
    return Fraction(number)


def character(value: object) -> str | None:
    """The one character that a str, also numpy's, is; None for all else, enums too."""
    return _tried(_character, value)


def _tried(convert: Callable[[object], _T | None], value: object) -> _T | None:
    try:
        return None if isinstance(value, bool | Enum) else convert(value)
    except Exception:  # noqa: BLE001 - the methods of a class may raise anything
        return None


def _integer(value: object) -> int | None:
    if isinstance(value, int):
        return int.__int__(value)
    # numpy registers its durations as integers, but they have no index.
    return int.__int__(operator.index(value)) if isinstance(value, Integral) else None


def _whole_number(value: object) -> int | None:
    if not isinstance(value, Decimal):
        return _integer(value)
    if not value.is_finite() or (value and value.adjusted() >= _MOST_DIGITS):
        return None
    whole = int(value)
    return whole if whole == value else None


def _real_number(value: object) -> float | None:
    if isinstance(value, float):
        return float.__float__(value)
    if isinstance(value, int | Integral):
        whole = _integer(value)
        return None if whole is None else float(whole)
    return float(value) if isinstance(value, Real | Decimal) else None


def _exact_number(value: object) -> Fraction | None:
    return Fraction(value) if isinstance(value, float | Decimal | Rational) else None


def _character(value: object) -> str | None:
    text = str.__str__(value) if isinstance(value, str) else ""
    return text if len(text) == 1 else None
