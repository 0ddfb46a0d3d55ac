"""Bit arithmetic, against worked examples and against the reference codec's own."""

from __future__ import annotations

from decimal import Decimal

import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles import reference_codec as reference

from typedcan.model.layout import bits, whole_byte
from typedcan.model.protocol import ByteOrder, Protocol, Signal

INTEL, MOTOROLA = ByteOrder.INTEL, ByteOrder.MOTOROLA


def signal(start: int, length: int, byte_order: ByteOrder, **values: Decimal | bool) -> Signal:
    ends = {"minimum": Decimal(0), "maximum": Decimal(1), **values}
    return Signal(
        name="Signal",
        start=start,
        length=length,
        byte_order=byte_order,
        **ends,  # type: ignore[arg-type]
    )


def expected_bits(one: Signal) -> tuple[int, ...]:
    return tuple(8 * byte + bit for byte, bit in reference.places(one))


@pytest.mark.parametrize(
    ("start", "length", "byte_order", "expected"),
    [
        (0, 8, INTEL, (0, 1, 2, 3, 4, 5, 6, 7)),
        (6, 4, INTEL, (6, 7, 8, 9)),
        (7, 8, MOTOROLA, (0, 1, 2, 3, 4, 5, 6, 7)),
        # BMS_Volt: byte 1 from bit 15 down to 8, then byte 2 from bit 23 down to 16.
        (15, 16, MOTOROLA, (*range(16, 24), *range(8, 16))),
        # Bits 1 and 0 of byte 0, then bits 15 and 14 at the top of byte 1.
        (1, 4, MOTOROLA, (14, 15, 0, 1)),
        (63, 2, MOTOROLA, (62, 63)),
        (8, 1, MOTOROLA, (8,)),
        # What leaves an 8-byte frame is listed all the same.
        (62, 4, INTEL, (62, 63, 64, 65)),
        (57, 4, MOTOROLA, (70, 71, 56, 57)),
    ],
)
def test_bits_go_from_the_least_to_the_most_significant(
    start: int, length: int, byte_order: ByteOrder, expected: tuple[int, ...]
) -> None:
    assert bits(signal(start, length, byte_order)) == expected


@given(st.integers(0, 511), st.integers(1, 64), st.sampled_from(ByteOrder))
def test_bits_are_those_of_the_reference_codec(start: int, length: int, order: ByteOrder) -> None:
    one = signal(start, length, order)
    assert bits(one) == expected_bits(one)


def test_bits_of_every_signal_of_the_standard_are_those_of_the_reference(
    protocol: Protocol,
) -> None:
    for message, one in protocol.signals():
        assert bits(one) == expected_bits(one)
        assert max(bits(one)) < 8 * message.length


@pytest.mark.parametrize(
    ("start", "length", "byte_order", "byte"),
    [
        (0, 8, INTEL, 0),
        (56, 8, INTEL, 7),
        (63, 8, MOTOROLA, 7),
        (7, 8, MOTOROLA, 0),
        (4, 8, INTEL, None),
        (0, 8, MOTOROLA, None),
        (0, 4, INTEL, None),
        (0, 16, INTEL, None),
    ],
)
def test_a_signal_that_fills_one_byte_exactly_is_known_as_such(
    start: int, length: int, byte_order: ByteOrder, byte: int | None
) -> None:
    assert whole_byte(signal(start, length, byte_order)) == byte


@pytest.mark.parametrize(
    ("length", "signed", "limits"),
    [(1, False, (0, 1)), (8, False, (0, 255)), (8, True, (-128, 127)), (1, True, (-1, 0))],
)
def test_raw_limits_are_what_the_bits_hold(
    *, length: int, signed: bool, limits: tuple[int, int]
) -> None:
    assert signal(0, length, INTEL, signed=signed).raw_limits == limits


@pytest.mark.parametrize(
    ("factor", "offset", "minimum", "maximum", "raw"),
    [
        ("0.4", "0", "0", "102", (0, 255)),
        ("0.1", "-1000", "-1000", "5553.5", (0, 65535)),
        ("1", "-40", "-40", "210", (0, 250)),
        # 0.05 is half a step: the first whole step inside is 1, the last below 0.95 is 9.
        ("0.1", "0", "0.05", "0.95", (1, 9)),
        ("0.1", "0", "-0.95", "-0.05", (-9, -1)),
        # A falling scale turns the ends around.
        ("-0.5", "10", "5", "10", (0, 10)),
    ],
)
def test_the_raw_range_lies_inside_the_physical_one(
    factor: str, offset: str, minimum: str, maximum: str, raw: tuple[int, int]
) -> None:
    numbers = {"factor": factor, "offset": offset, "minimum": minimum, "maximum": maximum}
    values = {name: Decimal(number) for name, number in numbers.items()}
    assert signal(0, 16, INTEL, **values).raw_range == raw
