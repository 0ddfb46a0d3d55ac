"""Plain numbers of whatever is given, and its text for errors: nothing raises."""

from __future__ import annotations

import math
from decimal import Decimal
from enum import IntEnum, StrEnum
from fractions import Fraction

import numpy as np
import pytest

from typedcan.model.plain import (
    character,
    exact_number,
    integer,
    real_number,
    shown,
    whole_number,
)


class Gear(IntEnum):
    """A code with a name."""

    REVERSE = 7


class Letter(StrEnum):
    """A text with a name."""

    A = "A"


class Silent:
    """Has no text."""

    def __repr__(self) -> str:
        raise RuntimeError


class Loud(str):
    """A text that answers for itself."""

    __slots__ = ()

    def __str__(self) -> str:
        raise RuntimeError

    def __getitem__(self, key: object) -> str:
        raise RuntimeError


class Seven(int):
    """A number that says that it is another."""

    def __int__(self) -> int:
        return 8

    def __float__(self) -> float:
        return 8.0


class Half(float):
    """The same for a float."""

    def __float__(self) -> float:
        return 8.0


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (5, "5"),
        ("5", "'5'"),
        (None, "None"),
        (Gear.REVERSE, "Gear.REVERSE"),
        (Silent(), "a Silent"),
        (["a\nb"], "['a\\nb']"),
        ([[[[1]]]], "[[[...]]]"),
        (10**40 - 1, "9" * 40),
        (-(10**40) + 1, "-" + "9" * 40),
        (10**40, "a number of about 40 digits"),
    ],
)
def test_a_value_is_shown_in_one_short_line(value: object, text: str) -> None:
    assert shown(value) == text


def test_a_number_of_more_digits_than_python_writes_out_is_not_written_out() -> None:
    assert shown(-(10**5000)) == "a number of about 5000 digits"


@pytest.mark.parametrize("length", [1, 59, 60, 61, 10**6])
def test_what_is_longer_than_60_characters_is_cut(length: int) -> None:
    class Long:
        def __repr__(self) -> str:
            return "x" * length

    expected = "x" * length if length <= 60 else "x" * 57 + "..."
    assert shown(Long()) == expected


def test_a_long_text_is_shown_by_its_beginning_and_its_end() -> None:
    text = shown("a" * 1000 + "z")
    assert len(text) == 60
    assert text.startswith("'aaaaaaaaaaaaaaaaaaaa")
    assert "..." in text
    assert text.endswith("z'")


def test_what_cannot_be_printed_is_escaped_and_counts_as_it_is_shown() -> None:
    class Odd:
        def __repr__(self) -> str:
            return "\x1b" * 20

    assert shown(Odd()) == "\\x1b" * 14 + "\\..."


@pytest.mark.parametrize(
    ("value", "number"),
    [
        (5, 5),
        (Seven(7), 7),
        (np.int16(-3), -3),
        (np.uint64(2**64 - 1), 2**64 - 1),
        (True, None),
        (np.bool_(1), None),
        (Gear.REVERSE, None),
        (5.0, None),
        (Decimal(5), None),
        (np.timedelta64(5, "s"), None),
        ("5", None),
        (None, None),
    ],
)
def test_an_integer_is_an_int_or_one_of_numpys(value: object, number: int | None) -> None:
    found = integer(value)
    assert found == number
    assert type(found) is type(number)


@pytest.mark.parametrize(
    ("value", "number"),
    [
        (5, 5),
        (Decimal("5.000"), 5),
        (Decimal(0), 0),
        (Decimal("-0E+999999999"), 0),
        (Decimal("1E+99"), 10**99),
        (Decimal("1E+100"), None),
        (Decimal("-1E+999999999"), None),
        (Decimal("5.5"), None),
        (Decimal("NaN"), None),
        (Decimal("Infinity"), None),
        (5.0, None),
        (False, None),
    ],
)
def test_a_whole_number_may_be_a_decimal_without_a_fraction(
    value: object, number: int | None
) -> None:
    found = whole_number(value)
    assert found == number
    assert type(found) is type(number)


@pytest.mark.parametrize(
    ("value", "number"),
    [
        (5, 5.0),
        (Seven(7), 7.0),
        (2.5, 2.5),
        (Half(0.5), 0.5),
        (np.float32(0.5), 0.5),
        (np.int8(-1), -1.0),
        (Fraction(1, 4), 0.25),
        (Decimal("0.125"), 0.125),
        (math.nan, None),
        (-math.inf, None),
        (10**400, None),
        (Decimal("1E+400"), None),
        (True, None),
        (Gear.REVERSE, None),
        ("2.5", None),
        (2.5j, None),
        (np.timedelta64(5, "s"), None),
    ],
)
def test_a_real_number_is_the_nearest_float(value: object, number: float | None) -> None:
    found = real_number(value)
    assert found == number
    assert type(found) is type(number)


@pytest.mark.parametrize(
    ("value", "number"),
    [
        (0, Fraction(0)),
        (2**60 + 1, Fraction(2**60 + 1)),
        (0.1, Fraction(3602879701896397, 2**55)),
        (Decimal("0.1"), Fraction(1, 10)),
        (Fraction(1, 3), Fraction(1, 3)),
        (np.float32(0.5), Fraction(1, 2)),
    ],
)
def test_an_exact_number_is_what_was_meant(value: object, number: Fraction) -> None:
    assert exact_number(value) == number


@pytest.mark.parametrize("value", [math.nan, "1", True, Gear.REVERSE, None])
def test_what_is_no_number_has_no_exact_one(value: object) -> None:
    with pytest.raises(ValueError, match=r" is no number$"):
        exact_number(value)


@pytest.mark.parametrize(
    ("value", "found"),
    [
        ("A", "A"),
        (np.str_("A"), "A"),
        (Loud("A"), "A"),
        ("", None),
        ("AB", None),
        (Letter.A, None),
        (65, None),
        (b"A", None),
    ],
)
def test_a_character_is_a_text_of_one(value: object, found: str | None) -> None:
    assert character(value) == found
    assert type(character(value)) is type(found)
