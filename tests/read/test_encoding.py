"""Files of any encoding: found where it can be known, asked for where it cannot."""

from __future__ import annotations

import codecs
from pathlib import Path

import pytest

from typedcan.databases.encoding import decode, find_encoding, read_text
from typedcan.model.errors import ReadError

CHINESE = "电池管理系统的最高温度, BMS 状态: 闭合"
GERMAN = "Temperatur des Kühlmittels in °C, Drehzahl und Größe für Fußgänger"
FRENCH = "Température du liquide, état déjà validé à 20 µs"


@pytest.mark.parametrize(
    ("text", "encoding", "found"),
    [
        ("plain", "ascii", "ascii"),
        (CHINESE, "utf-8", "utf-8"),
        (GERMAN, "utf-8", "utf-8"),
        (CHINESE, "utf-8-sig", "utf-8-sig"),
        (CHINESE, "utf-16", "utf-16"),
        (CHINESE, "gbk", "gb18030"),
        (CHINESE, "gb2312", "gb18030"),
        (GERMAN, "cp1252", "cp1252"),
        (FRENCH, "cp1252", "cp1252"),
        ('"°C" "µA"', "cp1252", "cp1252"),
        ('"m/s²"', "cp1252", "cp1252"),
    ],
)
def test_an_encoding_is_found(text: str, encoding: str, found: str) -> None:
    data = text.encode(encoding)
    assert find_encoding(data) == found
    assert decode(data, "x.dbc") == text


@pytest.mark.parametrize(
    ("text", "encoding"),
    [
        ("Температура охлаждающей жидкости", "cp1251"),  # not read here unasked
        ("Größe", "cp1252"),  # one word only, whose two letters are a Chinese character as well
        ("温度センサー", "shift_jis"),
    ],
)
def test_what_could_be_read_in_two_ways_is_never_guessed_wrong(text: str, encoding: str) -> None:
    data = text.encode(encoding)
    if find_encoding(data) is None:
        with pytest.raises(ReadError, match=r"x\.dbc: the encoding cannot be told"):
            decode(data, "x.dbc")
    else:
        assert decode(data, "x.dbc") == text
    assert decode(data, "x.dbc", encoding) == text


def test_a_given_encoding_that_does_not_fit_is_an_error_with_its_line() -> None:
    with pytest.raises(ReadError, match=r"^x\.dbc:2:1: not ascii: byte 0xB0$"):
        decode(b"first\n\xb0C", "x.dbc", "ascii")


@pytest.mark.parametrize("encoding", ["klingon", "hex", "rot13", "no\0t"])
def test_an_encoding_that_is_none_is_an_error(encoding: str) -> None:
    with pytest.raises(ReadError, match="no text encoding"):
        decode(b"x", "x.dbc", encoding)


def test_line_ends_of_all_systems_become_one(tmp_path: Path) -> None:
    path = tmp_path / "x.dbc"
    path.write_bytes(codecs.BOM_UTF8 + b"a\r\nb\rc\n")
    assert read_text(path) == "a\nb\nc\n"
