"""The DBC of a protocol that has what this standard has not: 11-bit frames, signs, no receivers."""

from __future__ import annotations

import dataclasses
from decimal import Decimal

import cantools
import pytest
from cantools.database.can import Database
from emit.dbc_lines import Dbc
from emit.other_protocol import HELLO, LONG_NAMES, OTHER, WHEELS

from dbcspec.emit.dbc import emit_dbc
from typedcan.model.canonical import canonical
from typedcan.model.errors import Location
from typedcan.model.numbers import number
from typedcan.model.protocol import Bus, Protocol


def rendered(protocol: Protocol = OTHER, bus: Bus | None = None) -> Dbc:
    return Dbc(protocol.name, emit_dbc(protocol, bus=bus).encode("ascii"), "ascii")


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ("0", "0"),
        ("-0.0", "0"),
        ("1E+3", "1000"),
        ("0.10", "0.1"),
        ("0.0000001", "0.0000001"),
        ("-40", "-40"),
        ("1677721.5", "1677721.5"),
    ],
)
def test_a_number_is_a_plain_decimal_without_trailing_zeros(value: str, text: str) -> None:
    assert number(Decimal(value)) == text


def test_lines_have_the_allowed_shape_and_say_what_the_model_says() -> None:
    texts = [line.text for line in rendered().lines]
    assert "BU_: ECU ABS TCU" in texts
    assert "BO_ 291 Wheels: 8 ECU" in texts
    assert ' SG_ Wheel_Speed : 7|12@0- (0.0625,-2.5) [-100|100] "m/s" ABS,TCU' in texts
    assert ' SG_ Gear : 16|3@1+ (1,0) [0|5] "" Vector__XXX' in texts
    assert "BO_ 2047 Hello: 2 ABS" in texts
    assert 'VAL_ 291 Gear 0 "Neutral" 7 "Reverse" ;' in texts


def test_an_11_bit_frame_says_so_in_its_frame_format() -> None:
    assert rendered().values("VFrameFormat") == {"291": "0", "2046": "0", "2047": "0"}


def test_a_long_period_fits_the_definition_of_the_attribute() -> None:
    definition = next(
        each for each in rendered().of("BA_DEF_") if each["name"] == "GenMsgCycleTime"
    )
    assert definition["type"] == "INT 0 100000"


def test_buses_of_different_bit_rates_give_one_each_and_the_whole_file_none() -> None:
    assert rendered().values("Baudrate") == {}
    body, chassis = OTHER.buses
    assert rendered(bus=body).values("Baudrate") == {"": "125000"}
    assert rendered(bus=chassis).values("Baudrate") == {"": "500000"}


def test_the_file_of_a_bus_leaves_out_what_nobody_on_it_hears() -> None:
    body, chassis = OTHER.buses
    quiet = rendered(bus=body)
    assert (quiet.nodes, quiet.of("BO_"), quiet.of("VAL_TABLE_")) == (["ECU"], [], [])
    heard = rendered(bus=chassis)
    assert [parts["name"] for parts in heard.of("BO_")] == ["Wheels"]
    assert [signal.receivers for signal in heard.signals[:2]] == [("ABS",), ("Vector__XXX",)]


def test_a_node_without_an_address_gets_none() -> None:
    assert rendered().values("NmStationAddress") == {"ECU": "1"}


def test_another_reader_finds_the_values_of_the_model() -> None:
    dbc = cantools.database.load_string(emit_dbc(OTHER), "dbc", strict=True)
    assert isinstance(dbc, Database)
    wheels = dbc.get_message_by_frame_id(0x123)
    assert not wheels.is_extended_frame
    # FFF in byte 0 and the upper half of byte 1 is -1: -1 x 0.0625 - 2.5 = -2.5625.
    # EA60 is 60000, low byte first.
    decoded = wheels.decode_simple(bytes.fromhex("FF F3 07 60 EA 5A 02 09"))
    assert {name: str(value) for name, value in decoded.items()} == {
        "Wheel_Speed": "-2.5625",
        "Level": "1.5",
        "Gear": "Reverse",
        "Text": "Very many",
        "Letter": "Z",
        "Slot": "Slot2",
        "Count": "9",
    }


def test_the_digest_changes_with_the_model_but_not_with_a_place_in_the_spec() -> None:
    moved = dataclasses.replace(WHEELS, where=Location("messages.yaml", 99))
    faster = dataclasses.replace(WHEELS, period=99)
    others = (LONG_NAMES, HELLO)
    assert dataclasses.replace(OTHER, messages=(moved, *others)).digest == OTHER.digest
    assert dataclasses.replace(OTHER, messages=(faster, *others)).digest != OTHER.digest


def test_a_kind_of_fact_that_a_message_has_not_is_no_part_of_its_digest() -> None:
    silent, periodic = (
        dataclasses.replace(WHEELS, period=None),
        dataclasses.replace(WHEELS, period=7),
    )
    assert "period" not in canonical(silent)
    assert "period=7" in canonical(periodic)
