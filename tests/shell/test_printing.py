"""Nothing that a terminal would obey, or that nobody could see, is printed as it is."""

from __future__ import annotations

import io
import json
import subprocess
import sys
import unicodedata
import warnings
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from shell.hostile import HIDDEN, hidden

from typedcan.shell.printing import (
    aligned,
    print_line,
    print_remark,
    print_text,
    print_warnings,
    printable,
    printable_json,
)

Capture = pytest.CaptureFixture[str]

CHARACTERS = st.one_of(
    st.characters(exclude_categories=[]),
    st.characters(categories=["Cc", "Cf", "Cs", "Zl", "Zp", "Zs"]),
)
TEXTS = st.text(CHARACTERS)


def spelled(character: str) -> str:
    """What is shown of a character, by its category in Unicode."""
    if unicodedata.category(character) not in HIDDEN:
        return character
    code = ord(character)
    if character in "\t\n\r":
        return "\\" + "tnr"["\t\n\r".index(character)]
    width = 2 if code < 0x100 else 4 if code < 0x10000 else 8
    return f"\\{'xuU'[width.bit_length() - 2]}{code:0{width}x}"


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("\x1b]0;title\x07\x1b[2J", r"\x1b]0;title\x07\x1b[2J"),
        ("one\r\ntwo\ttwo\x00", r"one\r\ntwo\ttwo\x00"),
        ("\x7f\x80\x9b31m\x9f", r"\x7f\x80\x9b31m\x9f"),
        ("file\u202egnp.exe\u2066\u200f", r"file\u202egnp.exe\u2066\u200f"),
        ("end of a\u2028line\u2029", r"end of a\u2028line\u2029"),
        ("bytes \udcff\ud800", r"bytes \udcff\ud800"),
        ("\ufeffzero\u200bwidth\U000e0041", r"\ufeffzero\u200bwidth\U000e0041"),
        ("电池 80 ℃，\u3000µ°Ω é \u0301 🔋", "电池 80 ℃，\u3000µ°Ω é \u0301 🔋"),
        (r"C:\new\x1b.dbc", r"C:\new\x1b.dbc"),
        ("", ""),
    ],
)
def test_what_nobody_could_see_is_shown_as_its_escape_and_all_else_as_it_is(
    text: str, shown: str
) -> None:
    assert printable(text) == shown


def test_each_character_that_is_in_use_is_shown_by_its_category() -> None:
    codes = (*range(0x32000), *range(0xE0000, 0xE0200), 0xF0000, sys.maxunicode)
    assert [code for code in codes if printable(chr(code)) != spelled(chr(code))] == []


@given(TEXTS)
def test_a_text_is_shown_character_by_character_on_one_line(text: str) -> None:
    shown = printable(text)
    assert shown == "".join(map(spelled, text))
    assert hidden(shown) == []
    assert "\n" not in shown
    assert printable(shown) == shown


@given(st.recursive(TEXTS, lambda inner: st.dictionaries(TEXTS, inner) | st.lists(inner)))
def test_json_loses_nothing_and_hides_nothing(value: object) -> None:
    for text in (printable_json(value), printable_json(value, indent=2)):
        assert json.loads(text) == value
        assert hidden(text) == []
    assert "\n" not in printable_json(value)


def test_json_stays_readable() -> None:
    assert printable_json({"温度": "℃\x9b"}) == '{"温度": "℃\\u009b"}'


def test_a_table_is_aligned_by_what_is_seen_of_its_cells() -> None:
    assert list(aligned(("name", "unit"), [("a\x1bb", "V"), ("c", "\n")])) == [
        "name    unit",
        "------  ----",
        r"a\x1bb  V",
        r"c       \n",
    ]


def test_a_line_is_one_line_and_a_text_is_as_many_as_it_has(capsys: Capture) -> None:
    print_line("one\nand\x1bmore")
    print_text("two\nthree\x1b[31m\n")
    print_text("")
    assert capsys.readouterr().out == "one\\nand\\x1bmore\ntwo\nthree\\x1b[31m\n"


def test_of_a_coloured_text_the_colours_alone_are_let_through(capsys: Capture) -> None:
    print_text("\x1b[1;31mred\x1b[0m\x1b[2J\x1b]0;x\x07\nplain\x9b31m", coloured=True)
    assert capsys.readouterr().out == "\x1b[1;31mred\x1b[0m\\x1b[2J\\x1b]0;x\\x07\nplain\\x9b31m\n"


def test_a_remark_is_one_line_beside_the_results(
    capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    print_remark("a\nb\x1bc")
    assert capsys.readouterr() == ("", "a\\nb\\x1bc\n")
    monkeypatch.setattr(sys, "stderr", None)  # as where it is closed
    print_remark("nobody sees this")
    assert capsys.readouterr().out == ""


def test_what_a_library_warns_of_is_a_remark_too(capsys: Capture) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        print_warnings()
        warnings.warn("glyph \x1b is\nmissing", RuntimeWarning, stacklevel=1)
    assert capsys.readouterr() == ("", "RuntimeWarning: glyph \\x1b is\\nmissing\n")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="has no file that takes nothing")
@pytest.mark.parametrize("tool", ["dbcspec", "swapcan"])
def test_a_remark_that_nobody_can_read_changes_no_exit_status(tool: str) -> None:
    with Path("/dev/full").open("w", encoding="ascii") as full:
        command = [sys.executable, "-m", tool, "no-such-command"]
        assert subprocess.run(command, stderr=full, check=False, timeout=60).returncode == 2


def test_a_remark_to_a_closed_stream_raises_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = io.StringIO()
    monkeypatch.setattr(sys, "stderr", stream)
    print_remark("there")
    assert stream.getvalue() == "there\n"
    stream.close()
    print_remark("nowhere")
