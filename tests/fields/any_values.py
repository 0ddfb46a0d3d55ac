"""Values of any type: numbers of all classes, near a field's own and far, and what is no value."""

from __future__ import annotations

import collections
import datetime
import enum
import math
import uuid
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from random import Random
from types import SimpleNamespace
from typing import Any, NamedTuple, TypeVar

import numpy as np

from swapcan import EncodeError, SignalState
from swapcan import messages as m

T = TypeVar("T")
ENUMS = [
    each
    for each in vars(m).values()
    if isinstance(each, type) and issubclass(each, enum.IntEnum) and each is not enum.IntEnum
]
"""Those of the protocol."""


class Near(NamedTuple):
    """Numbers that a field could hold, as a start, and the step between them."""

    low: float
    high: float
    step: float


class Rights(enum.IntFlag):
    """An int in the shape of flags."""

    READ = 1
    WRITE = 2


class Letter(enum.StrEnum):
    """A str that is an enum."""

    A = "A"
    SEVEN = "7"


class Ratio(float, enum.Enum):
    """A float that is an enum."""

    HALF = 0.5
    ONE = 1.0


class Exact(Decimal, enum.Enum):
    """A Decimal that is an enum."""

    ONE = "1"
    TWO = "2"


class OwnInt(int):
    """A class of a user's that is an int."""


class OwnFloat(float):
    """A class of a user's that is a float."""


class OwnText(str):
    """A class of a user's that is a str."""

    __slots__ = ()


def _fails(*_: object, **__: object) -> Any:
    raise ZeroDivisionError("this object raises whatever is done to it\n\x1b[2J")


_KEPT = {"__new__", "__init__", "__setattr__", "__init_subclass__", "__class_getitem__"}
"""Methods without which there would be no object."""


def _hostile(*bases: type) -> type[Any]:
    """A class of which everything raises that its objects or theirs can be asked to do."""
    kinds = (int, float, str, list, Decimal, Fraction, object)
    names = {name for kind in kinds for name in dir(kind) if callable(getattr(kind, name))}
    body = dict.fromkeys(names - _KEPT - {"__class__"}, _fails)
    return type("Hostile", bases, {**body, "name": property(_fails)})


class Untrue:
    """It passes for an int by its class, and has a text that no terminal should get."""

    __class__ = int  # type: ignore[assignment]

    def __repr__(self) -> str:
        return "\x1b[2J\n" * 1000


class TwoFaced(Fraction):
    """A number that is a better one each time it is asked for."""

    def __float__(self) -> float:
        self.asked = getattr(self, "asked", 0) + 1
        return 1.0 if self.asked == 1 else 1e300


HOSTILE: list[Callable[[], object]] = [
    _hostile(),
    lambda: _hostile(int)(1),
    lambda: _hostile(float)(1.0),
    lambda: _hostile(str)("A"),
    lambda: _hostile(Decimal)(1),
    lambda: _hostile(Fraction)(1),
    lambda: _hostile(list)([1]),
    type("x\n\x1b" * 99, (), {"__repr__": _fails}),
    Untrue,
    lambda: TwoFaced(1, 3),
]
"""What makes objects that raise, or lie, when they are looked at."""

ODD: list[object] = [
    *(None, ..., NotImplemented, object(), object, int, float, m.HvCommand, SignalState, math),
    *("", "A", "7", "Z", "O", "\0", "é", "AA", "1", "1.0", "nan", "HV On", "HV_ON", "电", "\ud800"),
    *("\x1b[2J\n", "x" * 10_000, OwnText("A"), OwnText("AB"), np.str_("A"), np.str_("AB")),
    *(b"", b"A", b"\x01", bytearray(b"A"), memoryview(b"A"), b"x" * 10_000),
    *((), [], {}, set(), frozenset({1}), [1], (1,), {1: 1}, {"a": [1]}, range(3), [[[[[[1]]]]]]),
    *([1.0] * 10_000, dict.fromkeys(range(1000)), collections.deque([1]), collections.Counter("a")),
    *(1 + 0j, 1j, complex(math.nan, 1), np.complex64(1), np.complex128(1)),
    *(datetime.datetime(2024, 1, 1), datetime.date(2024, 1, 1), datetime.timedelta(1)),
    *(uuid.UUID(int=1), Path("A"), SimpleNamespace(value=1), SimpleNamespace(__index__=1), len),
    *(np.datetime64("2024-01-01"), np.timedelta64(1, "s"), np.timedelta64("NaT"), np.void(b"A")),
    *(True, False, np.bool_(True), np.bool_(False), np.bytes_(b"A"), Rights.READ, Rights(3)),  # noqa: FBT003
    *(Letter.A, Letter.SEVEN, Ratio.ONE, Ratio.HALF, Exact.ONE, Exact.TWO, *SignalState),
    *(member for each in ENUMS for member in each),
]
"""Few of them are values, for few fields: a character, a state, a member of the own enum."""

FAR: list[object] = [
    *(math.nan, -math.nan, math.inf, -math.inf, 1.8e308, -1e300, 5e-324, -0.0, 2.0**53, 2.0**64),
    *(10**400, -(10**400), 10**10_000, -(10**10_000), 2**63, 2**64, 2**64 + 1, -(2**63) - 1),
    *(Decimal("NaN"), Decimal("sNaN"), Decimal("-sNaN123"), Decimal("Infinity"), Decimal("-0")),
    *(Decimal("1E+999999"), Decimal("-1E+999999"), Decimal("1E-999999"), Decimal("0E+999999")),
    *(Decimal("1." + 5000 * "0" + "1"), Decimal(5000 * "9"), Decimal("1.000"), Decimal("1E+1")),
    *(Fraction(10**5000, 3), Fraction(3, 10**5000), Fraction(10**5000 + 1, 10**5000), Fraction(5)),
    *(np.float16("inf"), np.float32("nan"), np.float64("-inf"), np.longdouble("nan")),
    *(np.longdouble("1e4000"), np.float32(3.4e38), np.uint64(2**64 - 1), np.int64(-(2**63))),
]
"""Numbers that are none, and numbers that no field holds or few."""

ARRAYS = "?bBhHiIqQefdgFDSUMmO"
"""Types of numpy's arrays."""

WHOLE: list[Callable[[int], object]] = [
    *(int, OwnInt, float, OwnFloat, Decimal, Fraction),
    lambda number: Decimal(number).scaleb(2).scaleb(-2),
    *(np.int8, np.uint8, np.int16, np.uint16, np.int32, np.uint32, np.int64, np.uint64),
    *(np.float16, np.float32, np.float64, np.longdouble),
]
"""What makes a number of a class from an int."""

REAL: list[Callable[[float], object]] = [
    *(float, OwnFloat, Decimal, Fraction, np.float16, np.float32, np.float64, np.longdouble),
    lambda number: Decimal(str(round(number, 3))),
    lambda number: Fraction(number).limit_denominator(1000),
]
"""What makes a number of a class from a float."""


def tried(action: Callable[[], T]) -> T | EncodeError:
    """What an action gives, or how it was refused."""
    try:
        return action()
    except EncodeError as refused:
        return refused


def any_value(source: Random, near: Near) -> object:
    """One value: half of them numbers about as large as the field's own."""
    chance = source.random()
    if chance < 0.3:
        number = source.uniform(near.low, near.high) + source.choice((0, 0, 1, -1)) * near.step
        if source.random() < 0.5:
            number = near.low + near.step * source.randint(-2, round(_steps(near)) + 2)
        return _made(source.choice(REAL), number)
    if chance < 0.6:
        low, high = round(near.low), round(near.high)
        whole = source.choice((source.randint(low - 2, high + 2), low - 1, high, high + 1))
        return _made(source.choice(WHOLE), whole)
    if chance < 0.65:
        return _made(source.choice(WHOLE), source.getrandbits(source.randint(1, 600)))
    if chance < 0.7:
        return source.choice(FAR)
    if chance < 0.74:
        return np.zeros(source.choice(((), (1,), (3, 2))), source.choice(ARRAYS))
    if chance < 0.78:
        return source.choice(HOSTILE)()
    if chance < 0.85:
        return chr(source.choice((source.randrange(128), source.randrange(0x110000))))
    return source.choice(ODD)


def _steps(near: Near) -> float:
    return min((near.high - near.low) / near.step, 1e9)


def _made(make: Callable[[Any], object], number: float) -> object:
    """The number in that class, or as it is where that has no room."""
    with np.errstate(all="ignore"):
        try:
            return make(number)
        except (OverflowError, ValueError):
            return number
