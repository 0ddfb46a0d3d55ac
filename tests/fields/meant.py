"""What a value means to a signal: raw values by exact arithmetic, from cantools' view of the DBC.

Nothing of swapcan decides here: which kind of field a signal has is all that is taken over.
"""

from __future__ import annotations

import enum
import math
from collections.abc import Mapping
from decimal import Decimal
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
from cantools.database.can import Signal
from fields.any_values import OwnFloat, OwnInt, OwnText, TwoFaced

from swapcan import SignalState

_INTS = (int, OwnInt, *(np.dtype(code).type for code in "bBhHiIlLqQ"))
_FLOATS = (float, OwnFloat, np.float16, np.float32, np.float64, np.longdouble)
_TEXTS = (str, OwnText, np.str_)
_FAR = Decimal("1E+400")
"""Beyond all floats."""


class Meant(NamedTuple):
    """The raw values that may be sent for a value, and whether it has to be sent."""

    raws: frozenset[int]
    must: bool


class Number(NamedTuple):
    """The exact number that a value is, if it is one, and whether nobody can doubt that."""

    exact: Fraction | None
    sure: bool = True


NOTHING = Meant(frozenset(), must=False)
NONE = Number(None)


def meant(kind: str, signal: Signal, own: type[enum.IntEnum] | None, value: Any) -> Meant:
    """What a value means to the signal of a field of that kind, whose enum is ``own``."""
    labels = {code: str(label) for code, label in (signal.choices or {}).items()}
    states = {code: label for code, label in labels.items() if label in _STATES}
    if kind == "LabelledField" and own and _is_a(value, own):
        return Meant(frozenset({value.value}), must=True)
    if kind != "LabelledField" and _is_a(value, SignalState):
        codes = frozenset(code for code, label in states.items() if label == value.value)
        return Meant(codes, must=bool(codes))
    if kind == "CharacterField" and type(value) in _TEXTS:
        codes = frozenset(code for code, label in labels.items() if label == value)
        return Meant(codes, must=bool(codes))
    if kind == "PhysicalField":
        return _measured(signal, states, real_number(value))
    number, sure = whole_number(value, decimals=kind in ("NumberField", "FilledField"))
    if number is None or not _allowed(kind, signal, labels, int(number)):
        return NOTHING
    return Meant(frozenset({int(number)}), must=sure)


_STATES = {state.value for state in SignalState}


def _is_a(value: object, *kinds: type) -> bool:
    """As `isinstance`, without asking the value or its class."""
    return any(kind in type(value).__mro__ for kind in kinds)


def _ends(signal: Signal) -> tuple[Fraction, Fraction]:
    return Fraction(str(signal.minimum)), Fraction(str(signal.maximum))


def _allowed(kind: str, signal: Signal, labels: Mapping[int, str], number: int) -> bool:
    low, high = _ends(signal)
    if kind == "CharacterField":
        return 0 <= number < 1 << signal.length
    if kind == "LabelledField":
        ends = [low, high, *map(Fraction, labels)]
        return min(ends) <= number <= max(ends)
    return low <= number <= high and labels.get(number) not in _STATES


def _measured(signal: Signal, states: Mapping[int, str], number: Number) -> Meant:
    if number.exact is None:
        return NOTHING
    factor, offset = Fraction(str(signal.scale)), Fraction(str(signal.offset))
    low, high = ((end - offset) / factor for end in _ends(signal))
    raw = (number.exact - offset) / factor
    # A float of the number, and sums with it, are off by some of the last bits.
    blur = (abs(number.exact) + abs(offset)) / factor / 2**48
    if not low - blur <= raw <= high + blur:
        return NOTHING
    near = range(math.floor(raw) - 1, math.ceil(raw) + 2)
    nearest = {each for each in near if abs(each - raw) <= Fraction(1, 2) + blur}
    allowed = {each for each in nearest if low <= each <= high} - states.keys()
    inside = low + blur <= raw <= high - blur
    return Meant(frozenset(allowed), must=number.sure and inside and allowed == nearest)


def whole_number(value: Any, *, decimals: bool) -> Number:
    """The whole number that a value is: an int of any class and, on demand, a Decimal."""
    if type(value) in _INTS:
        return Number(Fraction(int(value)))
    if type(value) is Decimal and decimals:
        number = real_number(value)
        return number if number.exact is not None and number.exact.denominator == 1 else NONE
    if _is_a(value, enum.Enum, bool):
        return NONE
    if _is_a(value, int):
        return Number(Fraction(int.__int__(value)), sure=False)
    return Number(Fraction(1), sure=False) if decimals and _is_a(value, Decimal) else NONE


def real_number(value: Any) -> Number:
    """The exact number that a value is, of any class of real numbers."""
    if type(value) in _FLOATS:
        return Number(Fraction(*value.as_integer_ratio())) if np.isfinite(value) else NONE
    if type(value) is Decimal:
        if not value.is_finite() or abs(value) >= _FAR:
            return NONE
        return Number(Fraction(value if abs(value) > 1 / _FAR or not value else 1 / _FAR))
    if type(value) is Fraction:
        return Number(value)
    if _is_a(value, float, Decimal, TwoFaced, Fraction) and not _is_a(value, enum.Enum):
        return Number(Fraction(1), sure=False)
    return whole_number(value, decimals=False)
