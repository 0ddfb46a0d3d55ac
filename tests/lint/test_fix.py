"""Mending DBC files: what was wrong is right afterwards, and nothing else has changed."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import cantools.database
import pytest
from cantools.database.can import Database
from hypothesis import given
from hypothesis import strategies as st

from dbcspec.fix import fix_bytes, fix_dbc
from typedcan.databases.dbc import read_dbc
from typedcan.databases.encoding import find_encoding

FIXTURES = sorted((Path(__file__).parent.parent / "fixtures" / "dbc").glob("*.dbc"))

over_all_fixtures = pytest.mark.parametrize("path", FIXTURES, ids=lambda path: path.stem)


def worn(text: str) -> str:
    """The same file as a careless editor leaves it, the lines inside of texts as they are."""
    lines = []
    for line in text.split("\r\n"):
        if line.count('"') % 2:
            lines.append(line)
            continue
        shown = line.replace(" SG_ ", "\tSG_  ", 1).replace(" : ", ":", 1)
        shown = shown.replace("BO_ ", "BO_   ", 1) if line.startswith("BO_ ") else shown
        if line.startswith("VAL_ "):
            shown = shown.replace('" ;', '";')
        lines.append(shown if line.startswith((" SG_ ", "BO_ ", "VAL_ ")) else line)
    return "\n".join(lines).rstrip("\n")


SOUND = """VERSION ""

BS_:

BU_: ECU HMI

BO_ 256 STATE: 8 ECU
 SG_ MODE M : 0|4@1+ (1,0) [0|15] "" HMI
 SG_ SPEED m1 : 8|16@0- (0.5,-1) [-1|126.5] "km/h" HMI,ECU

CM_ SG_ 256 SPEED "Two
 SG_ lines;  ";
VAL_ 256 MODE 0 "Off; really" 1 "On" ;
""".replace("\n", "\r\n").replace('"Two\r\n', '"Two\n')


def test_a_sound_file_stays_as_it_is() -> None:
    assert fix_dbc(SOUND) == (SOUND, [])


def test_a_worn_file_gets_its_form_back_and_every_fault_is_named() -> None:
    text, done = fix_dbc("\ufeff" + worn(SOUND))
    assert text == SOUND
    assert done == [
        "line 1: mended: a byte order mark",
        "line 1: mended: not CRLF at the end of the line, in 11 lines",
        "line 7: mended: unusual spacing of BO_",
        "line 8: mended: unusual spacing of SG_, in 2 lines",
        "line 13: mended: not one space before the semicolon of values",
        "line 13: mended: no line break at the end of the file",
    ]


@pytest.mark.parametrize("end", ["", "\r\n", "\r\n\r\n"])
def test_codes_at_the_end_get_the_semicolon_that_they_lack(end: str) -> None:
    text, done = fix_dbc(SOUND.removesuffix(" ;\r\n") + end)
    assert text.rstrip() == SOUND.rstrip()
    assert "line 13: mended: no semicolon at the end of the file" in done
    assert fix_dbc(text) == (text, [])


@over_all_fixtures
def test_a_mended_file_means_what_it_meant(path: Path, tmp_path: Path) -> None:
    data = path.read_bytes()
    encoding = find_encoding(data)
    assert encoding
    for text in (data.decode(encoding), worn(data.decode(encoding))):
        mended = tmp_path / path.name
        mended.write_bytes(fix_bytes(text.encode(encoding), encoding)[0])
        assert read_dbc(mended, encoding) == read_dbc(path, encoding)


@pytest.mark.parametrize(
    "path", [path for path in FIXTURES if path.stem != "orphans"], ids=lambda path: path.stem
)
def test_cantools_writes_a_mended_file_as_it_writes_the_file(path: Path) -> None:
    data = path.read_bytes()
    text = data.decode(find_encoding(data) or "").removeprefix("\ufeff")
    for before in (text, worn(text)):
        assert written(fix_dbc(before)[0]) == written(before)


def written(text: str) -> str:
    database = cantools.database.load_string(text, "dbc", strict=False)
    assert isinstance(database, Database)
    return database.as_dbc_string(sort_signals=None)


PIECES = (
    ' SG_ A : 0|8@1+ (1,0) [0|0] "" B',
    'SG_ A:0|8@1+(1, 0)[0|0]"km\\""B , C',
    "BO_ 1 A :8 B",
    'VAL_ 1 A 0 "x";',
    'BA_DEF_ "X" STRING ;',
    'BA_DEF_ BO_ "Y" INT 1 5;',
    "VAL_ 1 A 0",
    "// BO_ 1 A :8 B",
    *'"\\; \t\n\r\ufeff;',
    "\r\n",
)


@given(st.lists(st.sampled_from(PIECES), max_size=12).map("".join))
def test_mending_a_second_time_changes_nothing(text: str) -> None:
    mended, _ = fix_dbc(text)
    assert fix_dbc(mended) == (mended, [])


@given(st.lists(st.sampled_from([*PIECES[:4], *PIECES[6:]]), max_size=12).map("".join))
def test_where_no_default_is_missing_only_blanks_and_the_mark_change(text: str) -> None:
    mended, _ = fix_dbc(text)
    assert "".join(mended.split()) == "".join(text.lstrip("\ufeff").split())


def with_attributes(*lines: str) -> str:
    return SOUND + "".join(f"{line}\r\n" for line in lines)


def defaults(*lines: str) -> list[str]:
    """The default lines that mending adds to a sound file with these lines."""
    before = with_attributes(*lines)
    after = fix_dbc(before)[0]
    assert set(before.splitlines()) <= set(after.splitlines())
    return [line for line in after.splitlines() if line not in before.splitlines()]


def test_a_text_without_a_default_gets_the_empty_one() -> None:
    assert defaults('BA_DEF_ BO_  "Remark" STRING ;') == ['BA_DEF_DEF_  "Remark" "";']


def test_a_number_whose_0_means_none_gets_0() -> None:
    assert defaults('BA_DEF_ BO_  "GenMsgCycleTime" INT 0 65535;') == [
        'BA_DEF_DEF_  "GenMsgCycleTime" 0;'
    ]


def test_a_default_that_an_object_would_get_is_left_to_people() -> None:
    assert defaults('BA_DEF_ BU_  "Address" INT 0 255;', 'BA_ "Address" BU_ ECU 3;') == []
    assert defaults('BA_DEF_ BO_  "Lamp" ENUM  "Red","Green";') == []


def test_a_default_that_no_object_gets_is_the_first_value_allowed() -> None:
    assert defaults(
        'BA_DEF_ BU_  "Address" INT 1 255;',
        'BA_DEF_ BO_  "Lamp" ENUM  "Red","Green";',
        'BA_DEF_  "Depth" FLOAT -5 -2.5;',
        'BA_ "Address" BU_ ECU 3;',
        'BA_ "Address" BU_ HMI 4;',
        'BA_ "Lamp" BO_ 256 1;',
        'BA_ "Depth" -3;',
    ) == [
        'BA_DEF_DEF_  "Address" 1;',
        'BA_DEF_DEF_  "Lamp" "Red";',
        'BA_DEF_DEF_  "Depth" -2.5;',
    ]


def test_defaults_stand_behind_the_other_defaults() -> None:
    definitions = ('BA_DEF_ BO_  "Remark" STRING ;', 'BA_DEF_  "Other" STRING ;')
    given = ('BA_DEF_DEF_  "Other" "no";', 'BA_ "Other" "yes";')
    lines = fix_dbc(with_attributes(*definitions, *given))[0].splitlines()
    start = lines.index('BA_DEF_DEF_  "Other" "no";')
    assert lines[start + 1 : start + 3] == ['BA_DEF_DEF_  "Remark" "";', 'BA_ "Other" "yes";']


def test_with_its_new_defaults_every_message_and_signal_reads_the_same() -> None:
    before = with_attributes(
        'BA_DEF_ BO_  "GenMsgCycleTime" INT 0 65535;',
        'BA_DEF_ SG_  "GenSigStartValue" FLOAT 0 100;',
        'BA_DEF_ BO_  "GenMsgSendType" ENUM  "Cyclic","Event";',
        'BA_DEF_ SG_  "SPN" INT 0 524287;',
        'BA_ "GenSigStartValue" SG_ 256 MODE 3;',
    )
    after, done = fix_dbc(before)
    assert done == [
        "line 14: GenMsgCycleTime got the default 0",
        "line 15: GenSigStartValue got the default 0",
    ]
    assert facts(after) == facts(before)


def facts(text: str) -> Sequence[object]:
    database = cantools.database.load_string(text, "dbc")
    assert isinstance(database, Database)
    return [
        (message.name, message.cycle_time, message.send_type) for message in database.messages
    ] + [
        (signal.name, signal.initial, signal.spn, signal.comment, signal.choices)
        for message in database.messages
        for signal in message.signals
    ]


@pytest.mark.parametrize("encoding", ["gb18030", "cp1252", "utf-8", "utf-8-sig"])
def test_the_bytes_of_texts_stay_in_their_encoding(encoding: str) -> None:
    comment = "Größe ±" if encoding == "cp1252" else "温度 ±"
    sound = with_attributes(f'CM_ BO_ 256 "{comment}";')
    plain = encoding.removesuffix("-sig")
    mended, _ = fix_bytes(sound.replace("\r\n", "\n").encode(encoding), encoding)
    assert mended == sound.encode(plain)
