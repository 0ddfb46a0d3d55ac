"""Numbers that a float does not hold: each comes back bit for bit, or is refused."""

from __future__ import annotations

import random
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import cantools.database
import numpy as np
import pytest
from cantools.database.can import Database

from typedcan.commands.values import message_of
from typedcan.databases.dbc import read_dbc
from typedcan.dynamic import typed_protocol
from typedcan.shell.console import CommandError
from typedcan.wire.codec import Codec
from typedcan.wire.errors import EncodeError
from typedcan.wire.fields import ExactField, PhysicalField
from typedcan.wire.message import Message

CASES = Path(__file__).parents[1] / "fixtures" / "cases"
LINES = {
    "Plain": ("0|64@1+ (1,0) [0|0]", int),
    "Offset": ("0|64@1- (1,-5) [0|0]", int),
    "Steps": ("7|56@0+ (10,3) [0|0]", int),
    "Down": ("0|60@1- (-4,1000) [0|0]", int),
    "Most": ("0|64@1- (1000,7) [0|0]", int),
    "Narrow": ("0|49@1+ (1,0) [0|0]", float),
    "Halves": ("0|64@1+ (0.5,0) [0|0]", float),
    "Thirds": ("0|62@1- (3,0.5) [0|0]", float),
    "Degrees": ("0|64@1- (0.0000000001,0) [0|0]", float),
    "Far": ("0|32@1+ (0.000001,1000000000000) [0|0]", float),
}
"""A signal each, and what its field holds; all have a unit, so that they are measured values."""


@pytest.fixture(scope="module")
def database(tmp_path_factory: pytest.TempPathFactory) -> Path:
    lines = ['VERSION ""', "NS_ :", "BS_:", "BU_: A B"]
    for number, (name, (line, _)) in enumerate(LINES.items(), start=256):
        lines += [f"BO_ {number} {name}: 8 A", f' SG_ {name} : {line} "x" B', ""]
    path = tmp_path_factory.mktemp("wide") / "wide.dbc"
    path.write_text("\n".join(lines))
    return path


@pytest.mark.parametrize("name", LINES)
def test_each_payload_is_what_cantools_says_and_comes_back_or_is_refused(
    name: str, database: Path
) -> None:
    theirs = cantools.database.load_file(database)
    assert isinstance(theirs, Database)
    protocol, chance = typed_protocol(read_dbc(database)), random.Random(name)
    kind, codec = protocol.message(name), Codec(protocol)
    (field,) = kind.FIELDS.values()
    bits = field.length
    mask = (1 << bits) - 1
    raws = [0, 1, 7, mask, mask - 1, mask >> 1, (mask >> 1) + 1, (1 << 50) + 1, (1 << 52) - 1]
    refused = 0
    for raw in (*raws, *(chance.randrange(1 << bits) for _ in range(500))):
        data = (raw & mask).to_bytes(8, "little" if name != "Steps" else "big")
        data = data[1:] + b"\0" if name == "Steps" else data
        values: Any = theirs.decode_message(name, data, decode_choices=False)
        message = codec.decode(kind.FRAME_ID, data)
        value = getattr(message, field.name)
        assert (value, type(value)) == (values[name], LINES[name][1])
        try:
            assert codec.encode(message) == data
        except EncodeError as error:
            refused += 1 if "several raw values" in str(error) else 1000
    assert (0 < refused < 1000) == (name in ("Halves", "Thirds", "Degrees", "Far"))


def test_the_files_wide_signals_come_back_bit_for_bit() -> None:
    protocol, chance = typed_protocol(read_dbc(CASES / "wide.dbc")), random.Random(3)
    codec = Codec(protocol)
    for kind in protocol.messages:
        if kind.NAME == "WIDE3":
            continue
        for _ in range(200):
            data = chance.randbytes(8)
            assert codec.encode(codec.decode(kind.FRAME_ID, data)) == data


def _sent(database: Path, name: str, value: Any) -> int:
    protocol = typed_protocol(read_dbc(database))
    kind: Any = protocol.message(name)
    data = Codec(protocol).encode(kind(**{next(iter(kind.FIELDS)): value}))
    return int.from_bytes(data, "little")


@pytest.mark.parametrize(
    ("name", "value", "raw"),
    [
        ("Offset", (1 << 62) + 1 - 5, (1 << 62) + 1),
        ("Offset", Decimal((1 << 62) - 4), (1 << 62) + 1),
        ("Offset", np.int64(0), 5),
        ("Down", 1000 - 4 * ((1 << 58) + 3), (1 << 58) + 3),
        ("Down", 999, 0),
        ("Down", 997.5, 1),
        ("Plain", 2.0**63, 1 << 63),
        ("Plain", float(1 << 60), 1 << 60),
        ("Down", 997, 1),
        ("Degrees", Decimal("0.0000000003"), 3),
        ("Degrees", Decimal(5764607523034234881) / 10**10, 5764607523034234881),
        ("Degrees", Fraction(5764607523034234881, 10**10), 5764607523034234881),
        ("Degrees", 100, 10**12),
        ("Degrees", 1.5, 15 * 10**9),
        ("Degrees", 123.45678901239999, 1234567890124),
        ("Degrees", np.float32(0.5), 5 * 10**9),
        ("Halves", Decimal("9223372036854775807.5"), (1 << 64) - 1),
    ],
)
def test_what_is_given_exactly_is_sent_exactly(
    name: str, value: Any, raw: int, database: Path
) -> None:
    assert _sent(database, name, value) == raw


@pytest.mark.parametrize(
    ("name", "value", "problem"),
    [
        ("Offset", "1", "expected a number"),
        ("Plain", 2.0**64, "out of range"),
        ("Offset", 1 << 63, "out of range"),
        ("Steps", -8, "out of range"),
        ("Degrees", "1", "expected a number"),
        ("Degrees", float("nan"), "expected a number"),
        ("Degrees", 9e8, "several raw values"),
        ("Degrees", Decimal("922337203.6854775808"), "out of range"),
        ("Degrees", Decimal("1e9"), "out of range"),
        ("Far", 1000000000001.5, "several raw values"),
    ],
)
def test_what_cannot_be_sent_exactly_is_refused(
    name: str, value: Any, problem: str, database: Path
) -> None:
    with pytest.raises(EncodeError, match=problem):
        _sent(database, name, value)


def test_a_code_of_a_wide_signal_that_is_no_value_is_no_value(tmp_path: Path) -> None:
    path = tmp_path / "sna.dbc"
    lines = (
        'VERSION ""',
        "NS_ :",
        "BS_:",
        "BU_: A",
        "BO_ 256 Time: 8 A",
        ' SG_ Time : 0|60@1+ (2,1) [0|0] "us" A',
        "BO_ 257 Place: 8 A",
        ' SG_ Place : 0|60@1+ (0.5,1) [0|0] "us" A',
        'VAL_ 256 Time 1152921504606846975 "SNA" 3 "three" ;',
        'VAL_ 257 Place 1152921504606846975 "SNA" 3 "three" ;',
    )
    path.write_text("\n".join(lines))
    protocol = typed_protocol(read_dbc(path))
    codec, full = Codec(protocol), ((1 << 60) - 1).to_bytes(8, "little")
    all_ones = (1 << 60) - 1
    lasts = (2 * all_ones + 1, Fraction(all_ones, 2) + 1)
    for kind, last in zip(protocol.messages, lasts, strict=True):
        message = codec.decode(kind.FRAME_ID, full)
        (field,) = kind.FIELDS.values()
        assert str(getattr(message, field.name)) == "Signal Invalid"
        assert codec.encode(message) == full
        made: Any = kind
        with pytest.raises(EncodeError, match="raw 1152921504606846975"):
            codec.encode(made(**{field.name: last}))


def test_the_kinds_of_fields_say_what_they_hold(database: Path) -> None:
    kinds = {
        message.NAME: type(next(iter(message.FIELDS.values())))
        for message in typed_protocol(read_dbc(database)).messages
    }
    assert kinds == {
        **dict.fromkeys(LINES, ExactField),
        "Narrow": PhysicalField,
    }


@pytest.mark.parametrize(
    ("name", "text", "raw"),
    [
        ("Plain", "18446744073709551615", (1 << 64) - 1),
        ("Halves", "9223372036854775807.5", (1 << 64) - 1),
        ("Narrow", "3", 3),
    ],
)
def test_what_is_typed_at_the_command_line_loses_no_digit(
    name: str, text: str, raw: int, database: Path
) -> None:
    protocol = typed_protocol(read_dbc(database))
    message = message_of(protocol.message(name), [f"{name}={text}"])
    assert int.from_bytes(Codec(protocol).encode(message), "little") == raw


def test_what_is_typed_and_no_number_is_refused_in_one_line(database: Path) -> None:
    kind = typed_protocol(read_dbc(database)).message("Plain")
    with pytest.raises(CommandError, match=r"Plain\.plain: expected a number, not 'many'"):
        message_of(kind, ["plain=many"])


def test_a_whole_number_is_shown_with_its_unit(database: Path) -> None:
    kind: type[Message] = typed_protocol(read_dbc(database)).message("Most")
    (field,) = kind.FIELDS.values()
    assert field.text((1 << 72) + 7) == f"{(1 << 72) + 7} x"
