"""Messages with signals that overlap, lie outside or have no selector: the sound rest is there."""

from __future__ import annotations

import logging
import random
from pathlib import Path
from typing import Any

import pytest

from typedcan.databases.dbc import read_dbc
from typedcan.dynamic import typed_protocol
from typedcan.model.soundness import remarks, with_unique_names
from typedcan.wire.codec import Codec
from typedcan.wire.errors import EncodeError

CASES = Path(__file__).parents[1] / "fixtures" / "cases"


def _database(folder: Path, *lines: str) -> Path:
    path = folder / "made.dbc"
    path.write_text("\n".join(('VERSION ""', "NS_ :", "BS_:", "BU_: A B", *lines, "")))
    return path


def test_each_of_the_signals_that_share_bits_is_decoded() -> None:
    protocol, chance = typed_protocol(read_dbc(CASES / "overlap.dbc")), random.Random(1)
    codec = Codec(protocol)
    kind: Any = protocol.message("MSG")
    for _ in range(50):
        data = chance.randbytes(8)
        expected = {"group": int.from_bytes(data[:2], "little"), "part1": data[0], "other": data[4]}
        message = codec.decode(256, data)
        assert message == kind(**expected)
        assert codec.encode(message) == bytes((*data[:2], 0, 0, data[4], 0, 0, 0))


def test_signals_that_share_bits_are_not_sent_with_values_that_contradict_each_other() -> None:
    protocol = typed_protocol(read_dbc(CASES / "overlap.dbc"))
    kind: Any = protocol.message("MSG")
    with pytest.raises(EncodeError, match=r"MSG\.\w+: shares bits with another signal") as caught:
        Codec(protocol).encode(kind(group=0x0102, part1=4))
    assert (caught.value.field, caught.value.value) in {("group", 0x0102), ("part1", 4)}


def test_a_signal_outside_of_its_message_is_left_out_and_the_others_are_there() -> None:
    protocol = typed_protocol(read_dbc(CASES / "outside.dbc"))
    kind: Any = protocol.message("SHORT")
    assert list(kind.FIELDS) == ["p"]
    codec = Codec(protocol)
    assert codec.decode(256, b"\x07\xff") == kind(p=7)
    assert codec.encode(kind(p=9)) == b"\x09\x00"


def test_what_a_signal_selects_that_is_not_there_is_left_out_too(tmp_path: Path) -> None:
    path = _database(
        tmp_path,
        "BO_ 256 Mux: 2 A",
        ' SG_ Far M : 16|8@1+ (1,0) [0|0] "" B',
        ' SG_ Below m0 : 0|8@1+ (1,0) [0|0] "" B',
        ' SG_ Always : 15|8@0+ (1,0) [0|0] "" B',
        "BO_ 257 Ring: 2 A",
        ' SG_ One m0M : 0|8@1+ (1,0) [0|0] "" B',
        ' SG_ Two m0M : 8|8@1+ (1,0) [0|0] "" B',
        "SG_MUL_VAL_ 257 One Two 0-0;",
        "SG_MUL_VAL_ 257 Two One 0-0;",
        "BO_ 258 Lost: 2 A",
        ' SG_ Here : 0|8@1+ (1,0) [0|0] "" B',
        ' SG_ Gone m0 : 8|8@1+ (1,0) [0|0] "" B',
        "SG_MUL_VAL_ 258 Gone Nowhere 0-0;",
    )
    model = read_dbc(path)
    protocol = typed_protocol(model)
    assert {each.NAME: list(each.FIELDS) for each in protocol.messages} == {
        "Mux": ["always"],
        "Ring": [],
        "Lost": ["here"],
    }
    mux: Any = protocol.message("Mux")
    assert Codec(protocol).decode(256, b"\x01\x02") == mux(always=2)
    assert [*remarks(model)] == [
        "Mux.Far is left out: it lies outside of the 2 bytes of Mux",
        "Mux.Below is left out: Far, which selects it, lies outside of the 2 bytes of Mux",
        "Ring.One is left out: it selects itself",
        "Ring.Two is left out: it selects itself",
        "Lost.Gone is left out: it is selected by Nowhere, which Lost has not",
    ]


@pytest.mark.parametrize(
    ("case", "said"),
    [
        ("overlap", "overlap: MSG: Part1 shares bits with Group"),
        ("outside", "outside: SHORT.Q is left out: it lies outside of the 2 bytes of SHORT"),
        ("mux", ""),
        ("wide", ""),
        ("zero", ""),
    ],
)
def test_what_is_odd_is_one_warning_when_the_messages_are_made(
    case: str, said: str, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.WARNING):
        typed_protocol(read_dbc(CASES / f"{case}.dbc"))
    assert [each.message for each in caplog.records if each.name.startswith("typedcan")] == (
        [said] if said else []
    )


def test_a_long_list_of_what_is_odd_is_cut_and_shown_in_one_printable_line(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    lines = [f' SG_ S{number} : {8 * number}|8@1+ (1,0) [0|0] "" B' for number in range(2, 9)]
    path = _database(tmp_path, "BO_ 256 Short: 2 A", *lines, 'BA_DEF_ "DBName" STRING ;',
                     'BA_DEF_DEF_ "DBName" "";', 'BA_ "DBName" "a\x1b[2J";')  # fmt: skip
    typed_protocol(read_dbc(path))
    (record,) = (each for each in caplog.records if each.name.startswith("typedcan"))
    assert record.message.isprintable()
    assert record.message.startswith("a\\x1b[2J: Short.S2 is left out: ")
    assert record.message.count("is left out") == 3
    assert record.message.endswith("; and 4 more: dbcspec lint names them")


def test_two_of_one_name_are_both_there(tmp_path: Path) -> None:
    path = _database(
        tmp_path,
        "BO_ 256 Same: 3 A",
        ' SG_ Level : 0|8@1+ (1,0) [0|0] "" B',
        ' SG_ Level : 8|8@1+ (1,0) [0|0] "" B',
        ' SG_ Level_2 : 16|8@1+ (1,0) [0|0] "" B',
        "BO_ 257 Same: 1 A",
        ' SG_ Level : 0|8@1+ (1,0) [0|0] "" B',
    )
    model = read_dbc(path)
    protocol = typed_protocol(model)
    first, second = protocol.messages
    assert (first.NAME, second.NAME) == ("Same", "Same_2")
    names = [(field.name, field.dbc_name) for field in first.FIELDS.values()]
    assert names == [("level", "Level"), ("level_2", "Level_3"), ("level_2_2", "Level_2")]
    codec = Codec(protocol)
    for kind, data in ((first, b"\x01\x02\x03"), (second, b"\x04")):
        message = codec.decode(kind.FRAME_ID, data)
        assert bytes(message.to_raw().values()) == data
        assert codec.encode(message) == data
    same = with_unique_names(with_unique_names(model))
    assert same is with_unique_names(same)


def test_of_two_messages_with_one_identifier_frames_are_those_of_the_later(tmp_path: Path) -> None:
    path = _database(
        tmp_path,
        "BO_ 256 First: 1 A",
        ' SG_ One : 0|8@1+ (1,0) [0|0] "" B',
        "BO_ 256 Later: 1 A",
        ' SG_ Two : 0|8@1- (1,0) [0|0] "" B',
    )
    model = read_dbc(path)
    protocol = typed_protocol(model)
    first, later = (protocol.message(name) for name in ("First", "Later"))
    codec = Codec(protocol)
    made: Any = first
    assert type(codec.decode(256, b"\xff")) is later
    assert codec.encode(made(one=255)) == b"\xff"
    assert codec.decode(first, b"\xff") == made(one=255)
    assert [*remarks(model)] == ["First has the identifier of Later: frames are taken for Later"]
