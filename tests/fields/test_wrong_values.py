"""What each kind of field takes and refuses, value by value, and what the refusal says."""

from __future__ import annotations

import math
import string
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from fields.any_values import (
    Exact,
    Letter,
    OwnFloat,
    OwnInt,
    OwnText,
    Ratio,
    Rights,
)

import swapcan
from swapcan import EncodeError, Message, SignalState
from swapcan import messages as m


def refusal(message: Message) -> str:
    with pytest.raises(EncodeError) as refused:
        swapcan.encode(message)
    return refused.value.problem


def command(value: Any) -> Message:
    return m.V2B_CMD(hv_on_off=value)


def command_bits(message: Message) -> int:
    """Bits 4 and 5 of byte 1, table 14 row 3."""
    return swapcan.encode(message)[1] >> 4 & 3


@pytest.mark.parametrize(
    ("value", "code"),
    [
        (m.HvCommand.HV_ON, 1),
        (m.HvCommand.HV_OFF, 2),
        (m.HvCommand.SIGNAL_INVALID, 3),
        *((code, code) for code in range(4)),
        *((kind(2), 2) for kind in (OwnInt, np.int8, np.uint8, np.int64, np.uint64)),
    ],
)
def test_a_command_is_its_own_enum_or_a_code(value: object, code: int) -> None:
    assert command_bits(command(value)) == code


OTHER_ENUMS = [
    (m.BmsState.HV_CLOSED, "BmsState.HV_CLOSED"),
    (m.RelayState.OPEN, "RelayState.OPEN"),
    (m.AccessoryHvCommand.HV_ACC_ON, "AccessoryHvCommand.HV_ACC_ON"),
    (Rights.READ, "Rights.READ"),
    (Ratio.ONE, "Ratio.ONE"),
    (Exact.ONE, "Exact.ONE"),
    (Letter.SEVEN, "Letter.SEVEN"),
]
NO_NUMBERS: list[object] = [
    *(True, False, *np.array([True, False]), "80", "", "HV On", b"\x01", None, [1], {}, float),
    *(80 + 0j, np.complex64(80), np.array(80), np.array([80.0]), np.timedelta64(80, "s")),
    *(np.timedelta64(80), np.datetime64("2024-01-01"), np.str_("80"), np.bytes_(b"80")),
]


@pytest.mark.parametrize(
    ("value", "text"),
    [
        *OTHER_ENUMS,
        (SignalState.INVALID, "SignalState.INVALID"),
        *((value, repr(value)) for value in NO_NUMBERS),
        *((value, repr(value)) for value in (4, -1, 1.0, np.float64(2), Decimal(1), Fraction(2))),
        (np.int64(-1), repr(np.int64(-1))),
        (10**400, "a number of about 400 digits"),
    ],
)
def test_no_other_enum_and_no_bool_is_a_command(value: object, text: str) -> None:
    assert refusal(command(value)) == f"{text} is no HvCommand: expected HvCommand or a code 0 to 3"


def test_codes_beyond_those_printed_are_sent_as_far_as_the_bits_go() -> None:
    # Two bits, three labels; five bits, one label.
    charger: Any = m.B2C_Charger
    assert swapcan.encode(charger(charge_control=3))[4] & 3 == 3
    assert "4 is no ChargeControl" in refusal(charger(charge_control=4))
    pack: Any = m.B2V_SysCode1
    assert swapcan.encode(pack(sys_code_length=31))[1] >> 3 == 31
    assert "32 is no PackCodeLength" in refusal(pack(sys_code_length=32))


def status(soc: Any) -> Message:
    return m.B2V_ST2(soc=soc)


@pytest.mark.parametrize("kind", [float, OwnFloat, Decimal, Fraction, np.float32, np.float64])
def test_a_measured_value_may_be_of_any_class_of_numbers(kind: Any) -> None:
    # 80.25 % / 0.4 = 200.6; (-120.5 A + 1000) / 0.1 = 8795
    data = swapcan.encode(m.B2V_ST2(soc=kind(80.25), current=kind(-120.5)))
    assert (data[0], int.from_bytes(data[2:4], "little")) == (201, 8795)


@pytest.mark.parametrize(
    "kind", [int, OwnInt, np.int8, np.uint8, np.int64, np.uint64, np.float16, np.longdouble]
)
def test_a_measured_value_may_be_whole(kind: Any) -> None:
    assert swapcan.encode(status(kind(80)))[0] == 200


def test_the_ends_of_the_range_are_in_it() -> None:
    # 0 to 100.0 % are raw 0 to 250; 102 % would be raw 255, the invalid code.
    assert [swapcan.encode(status(soc))[0] for soc in (0, 0.0, Decimal("101.6"))] == [0, 0, 254]
    assert swapcan.encode(m.V2B_CMD(vehicle_speed=255))[2] == 255
    assert "-0.001 % is out of range; allowed are 0 to 102 %" in refusal(status(-0.001))
    assert "102.001 % is out of range" in refusal(status(102.001))
    for soc in (102, 102.0, Decimal(102), Fraction(102), np.float32(102)):
        assert "102 would be sent as raw 255, which means Signal Invalid" in refusal(status(soc))


@pytest.mark.parametrize(
    ("value", "text"),
    [
        *OTHER_ENUMS,
        *((value, repr(value)) for value in NO_NUMBERS),
        *(
            (value, repr(value))
            for value in map(Decimal, ("NaN", "sNaN", "-Infinity", "1E+999999"))
        ),
        *((value, repr(value)) for value in (np.float32("nan"), np.longdouble("inf"))),
        (10**400, "a number of about 400 digits"),
    ],
)
def test_what_is_no_number_is_no_measured_value(value: object, text: str) -> None:
    assert refusal(status(value)) == f"expected a number, 0 to 102 %, not {text}"


def test_a_fraction_beyond_all_floats_is_no_measured_value() -> None:
    assert "expected a number, 0 to 102 %" in refusal(status(Fraction(10**5000, 3)))
    assert swapcan.encode(status(Fraction(10**5000 + 1, 10**5000)))[0] == 2  # 1 % / 0.4


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, OwnFloat("inf")])
def test_a_float_that_is_no_finite_number_is_refused(value: float) -> None:
    assert str(float(value)) in refusal(status(value))


def count(value: Any) -> Message:
    return m.B2V_ST4(max_temp_position=value)


@pytest.mark.parametrize(
    "value", [200, OwnInt(200), np.uint8(200), np.int64(200), Decimal(200), Decimal("2.00E+2")]
)
def test_a_count_is_an_int_of_any_class_or_a_decimal_without_a_fraction(value: object) -> None:
    assert 200 in swapcan.encode(count(value))
    assert swapcan.encode(count(value)) == swapcan.encode(m.B2V_ST4(max_temp_position=200))


@pytest.mark.parametrize(
    ("value", "text"),
    [
        *OTHER_ENUMS,
        *((value, repr(value)) for value in NO_NUMBERS),
        *((value, repr(value)) for value in (5.0, np.float64(5), Fraction(5))),
        *((value, repr(value)) for value in map(Decimal, ("5.5", "sNaN", "1E+999999999"))),
    ],
)
def test_what_is_no_whole_number_is_no_count(value: object, text: str) -> None:
    assert refusal(count(value)) == f"expected a whole number, 0 to 255, not {text}"


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (256, "256 is out of range; allowed are 0 to 255"),
        (-1, "-1 is out of range; allowed are 0 to 255"),
        (Decimal(256), "256 is out of range; allowed are 0 to 255"),
        (10**400, "a number of about 400 digits is out of range; allowed are 0 to 255"),
        (SignalState.INVALID, "has no code for Signal Invalid"),
    ],
)
def test_a_number_out_of_range_is_no_count(value: object, text: str) -> None:
    assert refusal(count(value)) == text


def test_the_code_for_invalid_is_no_count() -> None:
    assert refusal(m.B2V_ST4(max_temp_csc_no=255)) == "255 means Signal Invalid"
    invalid = swapcan.encode(m.B2V_ST4(max_temp_csc_no=SignalState.INVALID))
    assert invalid == swapcan.encode(m.B2V_ST4())


def vin(value: Any) -> Message:
    return m.V2B_VIN(b1_8_15=value)


@pytest.mark.parametrize(
    ("value", "code"),
    [
        *((value, 0x4C) for value in ("L", OwnText("L"), np.str_("L"), 0x4C, np.uint8(0x4C))),
        *((code, code) for code in (0, 0x4F, 255)),
    ],
)
def test_a_character_is_one_of_the_table_or_a_code(value: object, code: int) -> None:
    assert swapcan.encode(vin(value))[1] == code


@pytest.mark.parametrize(
    ("value", "text"),
    [
        *OTHER_ENUMS,
        *((value, repr(value)) for value in NO_NUMBERS),
        *((value, repr(value)) for value in ("l", "?", "LL", "\x1b", np.str_("LL"), b"L")),
        *((value, repr(value)) for value in (256, -1, 76.0, Decimal(76))),
    ],
)
def test_what_is_no_character_of_the_table_is_refused(value: object, text: str) -> None:
    known = string.digits + string.ascii_uppercase
    assert refusal(vin(value)) == f"{text} is none of the characters {known} and no code 0 to 255"


def test_checksum_and_counter_are_filled_in_or_whole_numbers() -> None:
    given: Any = {"checksum": Decimal(7), "aliv": np.uint8(9)}
    data = swapcan.encode(m.V2B_CMD(**given))
    assert (data[0], data[1] & 15) == (7, 9)
    # The counter is 0 and high voltage invalid; 0xF0 ^ 0xFF ^ 0xFF ^ 0xFF ^ 0x3F = 0x30
    assert swapcan.encode(m.V2B_CMD()).hex() == "30f000ffffff3f00"
    assert swapcan.encode(m.V2B_CMD(aliv=SignalState.INVALID))[1] & 15 == 15
    for wrong in (15, 16, 2.0, True, m.HvCommand.HV_ON, "1"):
        assert refusal(m.V2B_CMD(aliv=wrong))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("message", "field", "value", "text"),
    [
        (m.V2B_CMD, "hv_on_off", m.HvCommand.HV_ON, "HV On"),
        (m.V2B_CMD, "hv_on_off", 1, "HV On"),
        (m.B2C_Charger, "charge_control", 3, "3"),
        (m.B2V_ST2, "soc", 80.25, "80.25 %"),
        (m.B2V_ST2, "soc", SignalState.INVALID, "Signal Invalid"),
        (m.B2V_ST4, "max_temp_position", 7, "7"),
        (m.V2B_VIN, "b1_8_15", "L", "L"),
        (m.V2B_VIN, "b1_8_15", 10, "0x0A"),
    ],
)
def test_a_value_has_a_text_with_its_label_or_unit(
    message: type[Message], field: str, value: Any, text: str
) -> None:
    assert message.FIELDS[field].text(value) == text
