"""What a signal that is a float takes: all numbers that have room in its bits."""

from __future__ import annotations

import math
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

from swapcan import EncodeError, SignalState
from typedcan.model.protocol import Signal
from typedcan.wire.fields import FloatField

FLOAT = FloatField(
    signal=Signal(name="Ratio", start=0, length=32, minimum=Decimal(0), maximum=Decimal(1)),
    name="ratio",
    dbc_name="Ratio",
    title="",
    length=32,
    factor=0.5,
    minimum=-1e39,
    maximum=1e39,
)


def test_a_float_takes_all_numbers_that_have_room_in_its_bits() -> None:
    numbers = (1.5, 2, Decimal("1.5"), Fraction(3, 2), np.float32(1.5), np.int8(2), -1.7e38)
    for number in numbers:
        assert FLOAT.to_raw("Gauge", number) == 2 * float(number)
    wrong: list[tuple[object, str]] = [
        (1.8e38, "1.8e+38 has no room in a float of 32 bits"),
        (math.nan, "nan is not a finite number"),
        (2e39, "2e+39 is out of range; allowed are -1e+39 to 1e+39"),
        (SignalState.INVALID, "has no code for Signal Invalid"),
        (True, "expected a number, -1e+39 to 1e+39, not True"),
        ("1.5", "not '1.5'"),
    ]
    for value, text in wrong:
        with pytest.raises(EncodeError, match=r"Gauge\.ratio: ") as refused:
            FLOAT.to_raw("Gauge", value)
        assert text in str(refused.value)


@pytest.mark.parametrize(("bits", "largest"), [(16, 65504.0), (32, 2.0**128 - 2.0**104)])
def test_the_largest_float_of_so_many_bits_has_room_and_twice_as_much_has_not(
    bits: int, largest: float
) -> None:
    field = replace(FLOAT, length=bits, factor=1.0, minimum=-1e300, maximum=1e300)
    assert field.to_raw("Gauge", largest) == largest
    for wrong in (2 * largest, -2 * largest):
        with pytest.raises(EncodeError, match=f"has no room in a float of {bits} bits"):
            field.to_raw("Gauge", wrong)


def test_a_number_that_the_factor_makes_infinite_is_refused() -> None:
    field = replace(FLOAT, length=64, minimum=-1e308, maximum=1e308)
    assert field.to_raw("Gauge", 8e307) == 1.6e308
    with pytest.raises(EncodeError, match="no room"):
        field.to_raw("Gauge", 1e308)
