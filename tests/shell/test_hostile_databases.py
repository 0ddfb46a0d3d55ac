"""`dbcspec` over files whose texts and names are control sequences: none reaches the terminal."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path

import pytest
from generator.small_spec import edited, write_project
from shell.hostile import NAME, esc_dbc, hidden, needs_any_file_name, printed
from shell.terminal import in_terminal

from typedcan.report.formats import FORMATS

SHOWN = r"\x1b]0;PWN\x07\x1b[2J"
"""What is to be seen of the texts in the DBC."""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with the DBC, and with one whose texts are others."""
    esc_dbc(tmp_path / "esc.dbc")
    esc_dbc(tmp_path / "new.dbc", (b"PWN", b"OWN"))
    return tmp_path


def test_show_and_textconv_print_what_the_texts_are(folder: Path) -> None:
    show, textconv = printed(
        folder, "dbcspec", ["show", "Msg", "--in", "esc.dbc"], ["textconv", "esc.dbc"]
    )
    assert f"\nhello {SHOWN}\n" in show
    assert f"0 lab{SHOWN}, 1 x\n" in show
    assert 'Msg Sig: unit "u\\u001b]0;PWN\\u0007\\u001b[2J"\n' in textconv
    (heading,) = (line for line in show.split("\n") if " unit " in line)
    (row,) = (line for line in show.split("\n") if "  Sig " in line)
    assert row.index(f"u{SHOWN}") == heading.index("unit")
    assert len(row) == heading.index("where") - 2


@pytest.mark.parametrize(
    "words", [["lint", "esc.dbc", "--profile", "house"], ["compare", "esc.dbc", "new.dbc"]]
)
def test_a_report_in_any_format_has_no_control_character(words: list[str], folder: Path) -> None:
    texts = printed(folder, "dbcspec", *([*words, "--format", each] for each in FORMATS))
    for text in texts:
        assert "PWN" in text


def test_what_is_made_of_the_file_is_told_line_by_line(folder: Path) -> None:
    load, generate, spec, lint, fix = printed(
        folder,
        "dbcspec",
        ["load", "esc.dbc", "--bit-rate", "500000", "--plot", "x.svg"],
        ["generate", "--from", "esc.dbc", "--out", "out"],
        ["import", "esc.dbc", "--out", "spec"],
        ["lint", "spec", "--profile", "house"],
        ["lint", "esc.dbc", "--fix"],
    )
    assert "bus, 500 kbit/s" in load
    assert "wrote esc/messages.py\n" in generate
    assert "wrote spec/messages.yaml\n" in spec
    assert "control character" in lint
    assert "esc.dbc: line 1: mended: " in fix


def test_a_matrix_of_other_texts_is_compared_with_the_spec(folder: Path) -> None:
    (folder / "pyproject.toml").write_text('[tool.dbcspec]\nname = "esc"\n', "ascii")
    *_, differences, written = printed(
        folder,
        "dbcspec",
        ["import", "esc.dbc", "--out", "spec"],
        ["matrix", "export", "new.dbc", "-o", "m.xlsx"],
        ["matrix", "import", "m.xlsx"],
        ["matrix", "import", "m.xlsx", "--write-spec"],
    )
    assert f"unit u{SHOWN} → u" in differences
    assert "wrote spec/" in written


def test_texts_of_a_spec_are_shown_and_forge_no_line(folder: Path) -> None:
    text = '"Heater\\e]0;PWN\\a\\e[2J\\u202e\\x9b\\nforged line"'
    messages = edited("messages.yaml", "english: Heater state", f"english: {text}")
    write_project(folder, messages=messages)
    show, *others = printed(
        folder, "dbcspec", ["show", "Heater"], ["lint"], ["generate"], ["check"], ["load"]
    )
    assert f"Heater{SHOWN}\\u202e\\x9b\\nforged line\n" in show
    for refused in others[:3]:
        assert "spec/messages.yaml:" in refused
    write_project(folder, messages=messages.replace("name: Heater", f"name: {text}"))
    for refused in printed(folder, "dbcspec", ["generate"], ["lint"]):
        assert "PWN" in refused


def test_lines_of_a_file_that_was_edited_by_hand_are_shown(folder: Path) -> None:
    write_project(folder)
    printed(folder, "dbcspec", ["generate"])
    path = folder / "out" / "thermo.dbc"
    path.write_bytes(path.read_bytes().replace(b'"Temperature"', b'"\x1b]0;PWN\x07\x1b[2J"'))
    check, in_json = printed(folder, "dbcspec", ["check"], ["check", "--json"])
    assert f'"{SHOWN}"' in check
    assert "u001b]0;PWN" in in_json


@needs_any_file_name
def test_a_name_in_an_answer_is_shown(folder: Path) -> None:
    commands = [
        ["show", NAME, "--in", "esc.dbc"],
        ["show", "Msg", "--in", NAME],
        ["lint", f"{NAME}.dbc"],
        ["lint", "esc.dbc", "--select", NAME],
        ["lint", "esc.dbc", "--config", NAME],
        ["lint", "esc.dbc", "--encoding", NAME],
        ["lint", "-C", NAME],
        ["compare", "esc.dbc", "esc.dbc", "--approvals", NAME],
        ["compare", "esc.dbc", "esc.dbc", "-o", f"{NAME}/x"],
        ["matrix", "export", "esc.dbc", "-o", f"{NAME}.xlsx"],
        ["import", "esc.dbc", "--out", NAME],
        [NAME],
        [f"--{NAME}"],
        ["lint", f"--{NAME}"],
        ["load", "esc.dbc", "--bit-rate", NAME],
    ]
    for text in printed(folder, "dbcspec", *commands):
        assert f"{SHOWN}\\r\\nforged line\\u202e\\x9b\\udcff" in text


@pytest.mark.skipif(sys.platform == "win32", reason="no pseudo-terminals")
def test_a_terminal_gets_colours_and_no_other_sequence(folder: Path) -> None:
    environment = {name: value for name, value in os.environ.items() if name != "NO_COLOR"}
    words = ("dbcspec", "lint", "esc.dbc", "--profile", "house")
    coloured, status = in_terminal(*words, environment=environment, folder=folder)
    plain, _ = in_terminal(*words, environment=environment | {"NO_COLOR": "1"}, folder=folder)
    assert status == 1
    assert "\x1b[1;31m" in coloured
    assert re.sub(r"\x1b\[[0-9;]*m", "", coloured) == plain
    assert SHOWN in plain
    assert hidden(plain.replace("\r\n", "\n")) == []
