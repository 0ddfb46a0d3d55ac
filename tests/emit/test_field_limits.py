"""Fields of files whose ranges and codes exceed the bits: sent as cantools reads them, or not."""

from __future__ import annotations

import importlib
import sys
import typing
from collections.abc import Iterator
from decimal import Decimal
from typing import Any, Literal

import cantools
import pytest
from cantools.database.can import Database

from dbcspec.emit.foreign import foreign_artifacts
from swapcan import EncodeError
from typedcan.databases.dbc import read_dbc
from typedcan.wire.packing import packer_of

WIDE = """VERSION ""

BU_: A B
BO_ 1 Wide: 40 A
 SG_ unsigned : 0|64@1+ (1,0) [0|18446744073709551615] "x" B
 SG_ signed : 64|64@1- (0.5,3) [0|0] "x" B
 SG_ falling : 128|8@1+ (-1,0) [-255|0] "x" B
 SG_ too_far : 136|8@1+ (1,0) [-10|1000] "" B
 SG_ far_steps : 144|8@1+ (0.5,-10) [-100|1000] "x" B
 SG_ far_code : 152|3@1+ (1,0) [0|7] "" B
 SG_ below : 160|8@1- (1,0) [0|7] "" B
 SG_ long_codes : 168|9@1+ (1,0) [0|511] "" B
 SG_ fifty_three : 192|53@1+ (1,0) [0|9007199254740991] "x" B
 SG_ Code3 : 248|3@1+ (1,0) [0|7] "" B
VAL_ 1 far_code 0 "a" 9 "beyond" ;
VAL_ 1 below -1 "under" 0 "none" ;
VAL_ 1 long_codes 0 "c" 511 "d" ;
VAL_ 1 Code3 0 "e" 1 "f" ;
"""


@pytest.fixture(scope="module")
def wide(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """The message of the file, as generated."""
    folder = tmp_path_factory.mktemp("limits")
    (folder / "wide.dbc").write_text(WIDE, "ascii")
    for name, data in foreign_artifacts(read_dbc(folder / "wide.dbc"), "of_limits").items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(data)
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(folder))
        yield importlib.import_module("of_limits.messages").Wide
    for name in [name for name in sys.modules if name.split(".")[0] == "of_limits"]:
        del sys.modules[name]


def raw(message: Any, signal: str) -> object:
    """What cantools finds in the frame."""
    database = cantools.database.load_string(WIDE, "dbc")
    assert isinstance(database, Database)
    reader = database.get_message_by_name("Wide")
    data = packer_of(message.MODEL).pack(message.to_raw())
    return reader.decode_simple(data, decode_choices=False, scaling=False)[signal]


@pytest.mark.parametrize(
    ("field", "value", "expected"),
    [
        ("unsigned", 0, 0),
        ("unsigned", 2.0**63, 2**63),
        ("unsigned", 2.0**64 - 2**12, 2**64 - 2**12),
        ("unsigned", 2**64 - 1, 2**64 - 1),
        ("signed", Decimal(-(2**62) + 3), -(2**63)),
        ("signed", 2**61, 2**62 - 6),
        ("signed", 2.0**40, 2**41 - 6),
        ("falling", -255, 255),
        ("falling", 0, 0),
        ("too_far", 255, 255),
        ("far_steps", 117.5, 255),
        ("far_steps", -10, 0),
        ("far_code", 7, 7),
        ("below", -1, -1),
        ("below", 7, 7),
        ("long_codes", 511, 511),
        ("fifty_three", 9007199254740991, 9007199254740991),
        ("fifty_three", 9007199254740991.0, 9007199254740991),
    ],
)
def test_the_ends_of_a_range_are_sent_as_far_as_the_bits_go(
    wide: Any, field: str, value: object, expected: int
) -> None:
    assert raw(wide(**{field: value}), wide.FIELDS[field].dbc_name) == expected


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("unsigned", 2**64),
        ("unsigned", 2.0**64),
        ("signed", 2.0**61),
        ("signed", Decimal(-(2**62)) + Decimal("2.5")),
        ("signed", 2.0**62 + 2**12),
        ("signed", -(2.0**63)),
        ("falling", -256),
        ("falling", 1),
        ("too_far", 256),
        ("too_far", -1),
        ("far_steps", 118),
        ("far_steps", -10.5),
        ("far_code", 9),
        ("far_code", 8),
        ("below", -2),
        ("below", 8),
        ("long_codes", 512),
        ("fifty_three", 2.0**53),
    ],
)
def test_what_the_bits_cannot_hold_is_refused(wide: Any, field: str, value: object) -> None:
    with pytest.raises(EncodeError):
        wide(**{field: value}).to_raw()


def test_the_member_of_a_code_beyond_the_bits_is_refused(wide: Any) -> None:
    codes = wide.FIELDS["far_code"].enum
    assert wide(far_code=codes.A).to_raw()["far_code"] == 0
    with pytest.raises(EncodeError, match="BEYOND is no"):
        wide(far_code=codes.BEYOND).to_raw()


def test_plain_codes_are_listed_up_to_eight_bits_and_are_int_beyond(wide: Any) -> None:
    hints = typing.get_type_hints(wide)
    enums = {name: field.enum for name, field in wide.FIELDS.items() if hasattr(field, "enum")}
    assert hints["far_code"] == enums["far_code"] | Literal[0, 1, 2, 3, 4, 5, 6, 7]
    assert hints["below"] == enums["below"] | int
    assert hints["long_codes"] == enums["long_codes"] | int
    # Its table is called as the type of three bits is: the enum gives way.
    assert hints["code3"] == enums["code3"] | Literal[0, 1, 2, 3, 4, 5, 6, 7]
