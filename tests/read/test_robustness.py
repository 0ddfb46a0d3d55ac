"""What is no DBC, or half of one: one line that names the file, in bounded time."""

from __future__ import annotations

import os
import random
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from typedcan.databases.dbc import read_any, read_dbc
from typedcan.databases.encoding import decode, find_encoding
from typedcan.databases.sizes import refuse_large
from typedcan.model.errors import ReadError
from typedcan.model.protocol import Protocol
from typedcan.model.soundness import remarks

SMALL = """VERSION ""

BU_: A B
BO_ 1 First: 8 A
 SG_ One : 0|8@1+ (1,0) [0|255] "V" B
 SG_ Two : 8|8@1+ (1,0) [0|255] "" B

CM_ SG_ 1 One "a comment";
BA_DEF_ BO_  "GenMsgCycleTime" INT 0 65535;
BA_DEF_DEF_  "GenMsgCycleTime" 0;
BA_ "GenMsgCycleTime" BO_ 1 100;
VAL_ 1 One 0 "Off" 1 "On" ;
"""


def refusal(path: Path) -> str:
    """The one line with which a file is refused."""
    with pytest.raises(ReadError) as caught:
        read_dbc(path)
    line = str(caught.value)
    assert "\n" not in line
    assert line.startswith(str(path))
    return line.removeprefix(str(path))


def outcome(path: Path) -> Protocol | str:
    """The protocol, or the line that says why there is none."""
    try:
        return read_dbc(path)
    except ReadError as error:
        return str(error)


def file(folder: Path, data: bytes | str) -> Path:
    path = folder / "x.dbc"
    path.write_bytes(data if isinstance(data, bytes) else data.encode("utf-8"))
    return path


@pytest.mark.parametrize(
    ("data", "text"),
    [
        (b"", ": the file is empty"),
        (b" \r\n\t\n", ": the file is empty"),
        (b"\x7fELF\x00\x01\x02", ": is not a text file"),
        (b"PK\x03\x04 and more", ": is no DBC file: it begins with"),
        (b"<html>", ": is no DBC file"),
        (b":::", ": is no DBC file"),
        ('VERSION ""\nnonsense here\n', ":2:1: this is no line of a DBC file"),
        (SMALL.replace("@1+ (1,0) [0|255] \"V\"", ""), ":5"),
        (SMALL.replace("First: 8", "First: 99999"), ":4:1: First: no message has so many bytes"),
        (SMALL.replace("0|8@", "0|100000000@"), ":5:1: One: no message has so many bits"),
        (SMALL.replace('"a comment"', '"a comment'), "a quote is opened and never closed"),
        (SMALL.replace("BO_ 1 First", "BO_ 4294967295 First"), ":4:1: First: 4294967295 is"),
        (SMALL.replace("BO_ 1 First", "BO_ 2048 First"), ":4:1: First: 2048 is no"),
        (SMALL + "SG_MUL_VAL_ 1 Two One 0-4294967295;\n", ":13:1: more than "),
        ("VERSION \"\"\n" + "BO_ 1 A: 8 X\n" * 50_001, ":50002:1: more than 50000 messages"),
        ("VERSION \"\"\nBU_: " + "A " * 2_100_000, ":2:1: the line is longer than"),
    ],
)  # fmt: skip
def test_a_file_that_is_no_dbc_says_so_in_one_line(
    tmp_path: Path, data: bytes | str, text: str
) -> None:
    assert text in refusal(file(tmp_path, data))


@pytest.mark.parametrize("scale", ["(0,0)", "(1e999,0)", "(1,1e999)"])
def test_a_signal_without_a_scaling_takes_no_other_with_it(scale: str, tmp_path: Path) -> None:
    text = SMALL.replace('(1,0) [0|255] "V"', f'{scale} [0|1e999] "V"')
    protocol = read_dbc(file(tmp_path, text))
    assert [*remarks(protocol)] == [
        "First.One is left out: it has a factor that is 0, or no finite number"
    ]
    assert "One" in [signal.name for signal in protocol.messages[0].signals]


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("kcd", '<Message id="1" name="M" length="100000000"/>'),
        ("kcd", "<Signal name='S' offset='99999999' length='8'/>"),
        ("sym", "[M]\nLen=100000000\n"),
        ("sym", "[M]\nVar=S unsigned 0,99999999\n"),
        ("arxml", "<FRAME-LENGTH>100000000</FRAME-LENGTH>"),
        ("arxml", "<A><BASE-TYPE-SIZE>8</BASE-TYPE-SIZE>\n<LENGTH>100000000</LENGTH></A>"),
        ("arxml", "<START-POSITION>99999999</START-POSITION>"),
        ("arxml", "<a:LENGTH xmlns:a='b'> 0x5F5E100 </a:LENGTH>"),
        ("kcd", "<Signal name='S' offset='&#57;99999999' length='8'/>"),
        ("kcd", "<Signal name='S' offset='0' length='+1_0_0000000'/>"),
        ("sym", "{SIGNALS}\nSig=s unsigned 100000000\n"),
        ("sym", "{SIGNALS}\nSig=s unsigned 8\n[M]\nSig=s // far\n 100000000\n"),
        ("sym", "[M]\nLen // long\n=\n00100000000\n"),
    ],
)
def test_sizes_that_no_message_has_are_refused_before_they_are_used(
    name: str, text: str, tmp_path: Path
) -> None:
    path = tmp_path / f"x.{name}"
    path.write_text(text)
    with pytest.raises(ReadError, match="no message has so many bits"):
        read_any(path)


@pytest.mark.parametrize("number", ["1e999999999", "-1.5E+99999", ".5e10000"])
def test_a_number_without_an_end_is_refused_in_its_line(number: str, tmp_path: Path) -> None:
    definition = 'BA_DEF_ BO_ "GenMsgCycleTime" INT 0 1;\n'
    path = file(tmp_path, f'{SMALL}{definition}BA_DEF_DEF_ "GenMsgCycleTime" {number};\n')
    with pytest.raises(ReadError, match=r":14:1: nothing has a value of "):
        read_dbc(path)


def test_a_number_that_is_nearly_nothing_is_nothing(tmp_path: Path) -> None:
    text = SMALL.replace("[0|255]", "[2.745744098767810851E-4321|255]")
    assert read_dbc(file(tmp_path, text)).messages[0].signals[0].minimum == 0


def test_a_signal_of_thousands_of_bits_may_say_its_range(tmp_path: Path) -> None:
    text = SMALL.replace("[0|255]", "[0|2.745744098767810851E+4161]")
    assert read_dbc(file(tmp_path, text)).messages[0].signals[0].maximum == 255


def test_a_name_may_look_like_such_a_number(tmp_path: Path) -> None:
    text = SMALL.replace("First", "A_1e99999").replace('"V"', '"1e99999"')
    assert read_dbc(file(tmp_path, text)).messages[0].name == "A_1e99999"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('<!DOCTYPE x [<!ENTITY a "b">]><x y="&a;"/>', ":1: declares a document type"),
        ("\n" + "<a>" * 300 + "</a>" * 300, ":2: nested too deeply"),
        ("<a>\n<b></a>", ":2:6: not XML: mismatched tag"),
    ],
)
@pytest.mark.parametrize("suffix", ["kcd", "arxml"])
def test_xml_that_is_no_database_is_refused_with_its_line(
    suffix: str, text: str, said: str, tmp_path: Path
) -> None:
    path = tmp_path / f"x.{suffix}"
    path.write_text(text)
    with pytest.raises(ReadError) as caught:
        read_any(path)
    assert said.removeprefix(":").split(":", 1)[1] in str(caught.value)
    assert str(caught.value).startswith(f"{path}:{said.split(':')[1]}:")


def test_a_cycle_time_of_a_sym_file_that_is_infinite_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "x.sym"
    head = 'FormatVersion=6.0 // x\nTitle="t"\n\n{SENDRECEIVE}\n'
    path.write_text(f"{head}[M]\nID=001h\nLen=8\nCycleTime=1e400\nVar=s unsigned 0,8\n")
    with pytest.raises(ReadError, match=r"M: no cycle time is so long"):
        read_any(path)


@pytest.mark.parametrize(("place", "refused"), [(32760, False), (32761, True)])
@pytest.mark.parametrize(
    ("suffix", "text"),
    [
        ("kcd", "<x>\n<Signal name='S' offset='{}' length='8'/></x>"),
        ("arxml", "<x>\n<START-POSITION>{}</START-POSITION></x>"),
        ("sym", "[M]\nVar=S unsigned {},8\n"),
    ],
)
def test_the_largest_place_is_that_of_4095_bytes_and_what_is_beyond_has_its_line(
    suffix: str, text: str, place: int, *, refused: bool
) -> None:
    if refused:
        with pytest.raises(ReadError, match=r"^x:2:1: no message has so many bits: 32761$"):
            refuse_large(text.format(place), suffix, "x")
    else:
        refuse_large(text.format(place), suffix, "x")


def test_a_missing_file_and_a_folder_are_refused(tmp_path: Path) -> None:
    assert refusal(tmp_path / "none.dbc") == ": there is no such file"
    assert refusal(tmp_path) == ": is not a file"


@pytest.mark.skipif(os.name == "nt" or os.geteuid() == 0, reason="everybody may read everything")
def test_a_file_that_may_not_be_read_is_refused(tmp_path: Path) -> None:
    path = file(tmp_path, SMALL)
    path.chmod(0)
    assert "cannot be read" in refusal(path)


def test_fifty_megabytes_are_refused_before_they_are_read(tmp_path: Path) -> None:
    path = tmp_path / "x.dbc"
    with path.open("wb") as big:
        big.write(b'VERSION ""\n')
        big.truncate(50 * 2**20)
    assert refusal(path) == ": is larger than 16 MB"


def test_the_largest_size_is_the_callers_choice(tmp_path: Path) -> None:
    path = file(tmp_path, SMALL)
    assert read_dbc(path, largest=len(SMALL)).messages
    with pytest.raises(ReadError, match="is larger than"):
        read_dbc(path, largest=len(SMALL) - 1)


def test_a_file_cut_anywhere_is_refused_or_has_only_what_is_whole(tmp_path: Path) -> None:
    whole = read_dbc(file(tmp_path, SMALL))
    refused = 0
    for length in range(1, len(SMALL)):
        cut = SMALL[:length]
        protocol = outcome(file(tmp_path, cut))
        if isinstance(protocol, str):
            refused += 1
            assert "\n" not in protocol
            continue
        # No message or signal that the text begins is lost without a word.
        assert len(protocol.messages) == len(re.findall(r"^BO_ ", cut, re.MULTILINE))
        assert sum(1 for _ in protocol.signals()) == len(re.findall(r"^ SG_ ", cut, re.MULTILINE))
        assert {message.name for message in protocol.messages} <= {
            message.name for message in whole.messages
        }
    assert refused > len(SMALL) // 2


def test_a_file_cut_in_a_line_says_so(tmp_path: Path) -> None:
    cut = SMALL[: SMALL.index('[0|255] "" B')]
    assert refusal(file(tmp_path, cut)) == ": the last statement is cut off"


def test_codes_at_the_end_that_lack_their_semicolon_only_are_there(tmp_path: Path) -> None:
    whole, ended = read_dbc(file(tmp_path, SMALL)), SMALL.rstrip().removesuffix(";")
    for text in (ended, ended.rstrip(), f"{ended}\n\n"):
        assert read_dbc(file(tmp_path, text)) == whole
    for cut in (ended.rstrip()[:-1], ended.replace(' 1 "On"', " 1")):
        assert "cut off" in refusal(file(tmp_path, cut)) or "never closed" in refusal(
            file(tmp_path, cut)
        )


def test_mutilated_files_are_read_or_refused_and_nothing_else(tmp_path: Path) -> None:
    chance = random.Random(1)
    for _ in range(200):
        text = list(SMALL)
        for _ in range(chance.randint(1, 6)):
            where = chance.randrange(len(text))
            text[where : where + chance.randint(0, 4)] = chance.choice(
                ['"', ";", "\\", "M", "-1", "SG_ ", "\n", "99999999999999999999", "\x00", "ä"]
            )
        result = outcome(file(tmp_path, "".join(text)))
        assert isinstance(result, Protocol) or "\n" not in result


@given(st.binary(max_size=200))
def test_any_bytes_are_decoded_or_refused(data: bytes) -> None:
    encoding = find_encoding(data)
    if encoding is None:
        with pytest.raises(ReadError, match=r"^x\.dbc: the encoding"):
            decode(data, "x.dbc")
    elif encoding != "utf-16":  # whose surrogates may be alone
        assert decode(data, "x.dbc").encode(encoding) == data


@pytest.mark.parametrize("ending", ["kcd", "sym", "arxml"])
def test_broken_files_of_other_formats_are_refused_in_one_line(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"x.{ending}"
    path.write_text("<a><b></a>", "ascii")
    with pytest.raises(ReadError) as caught:
        read_any(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)
