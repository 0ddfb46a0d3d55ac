"""`swapcan` over names and texts that are control sequences: none reaches the terminal."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path

import pytest
from shell.hostile import NAME, esc_dbc, hidden, needs_any_file_name, printed
from shell.terminal import in_terminal

pytestmark = needs_any_file_name

LOG = f"{NAME}.log"
DBC = f"{NAME}.dbc"
SHOWN = r"a\x1b]0;PWN\x07\x1b[2J"
"""What is to be seen of the name; of the line break in it an error shows a space."""

FRAMES = """(1.0) can0 1882D0F3#C8FA5B22FFFFBD0B
(1.1) can0 1882D0F3#C8FA5B22FFFFBD0B
(1.2) can0 100#0000000000000000
(1.3) can0 100#0100000000000000
(1.4) ca\x1b[2Jn 18C1D0F3#0000000000000000
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a log and the DBC, both of that name."""
    esc_dbc(tmp_path / DBC)
    (tmp_path / LOG).write_text(FRAMES, "utf-8")
    return tmp_path


def test_what_becomes_of_a_log_is_told_line_by_line(folder: Path) -> None:
    decode, decode_json, convert, convert_json, conform, conform_json, rules = printed(
        folder,
        "swapcan",
        ["decode", LOG],
        ["decode", LOG, "--json"],
        ["convert", LOG, "-o", f"{NAME[:-1]}.csv", "--dbc", DBC, "--labels"],
        ["convert", LOG, "-o", "x.parquet", "--json"],
        ["conform", LOG, "--verbose", "--html", f"{NAME}.html", "--junit", "j", "--csv", "c"],
        ["conform", LOG, "--json", "--language", "zh"],
        ["conform", "--list-rules"],
    )
    assert r"damaged at line 5: no line of a candump log: '(1.4) ca\x1b[2Jn" in decode
    assert "\x1b" not in decode + decode_json
    assert f"wrote {SHOWN}" in convert
    assert json.loads(convert_json.splitlines()[0])["damage"][0]["path"] == LOG
    assert f"Conforms: {SHOWN}" in conform
    assert f"wrote {SHOWN}" in conform
    assert json.loads(conform_json.partition("\n")[2])["logs"][0]["log"] == LOG
    assert "checksum" in rules


def test_plots_of_texts_of_a_database_are_told_in_one_line_each(folder: Path) -> None:
    words = ["plot", LOG, "--signals", "Sig", "--dbc", DBC, "-o"]
    for text in printed(folder, "swapcan", [*words, f"{NAME}.html"], [*words, f"{NAME}.png"]):
        assert f"swapcan: {SHOWN}" in text
        assert "Warning" not in text


def test_a_name_in_an_error_is_shown(folder: Path) -> None:
    bus = ["-i", "virtual"]
    commands = [
        ["decode", NAME],
        ["decode", DBC],
        ["convert", f"{NAME}.blf", "-o", "y.csv"],
        ["convert", LOG, "-o", f"{NAME}.csv"],
        ["convert", LOG, "-o", "y.csv", "--messages", NAME],
        ["convert", LOG, "-o", "y.csv", "--dbc", NAME],
        ["plot", LOG, "--signals", NAME, "-o", "y.html"],
        ["plot", LOG, "--signals", "SOC", "-o", f"{NAME}/y.html"],
        ["conform", NAME],
        ["conform", LOG, "--tolerance", NAME],
        ["listen", "-i", NAME],
        ["listen", *bus, "-c", NAME, "--seconds", "0.1"],
        ["monitor", *bus, "-c", NAME, "--seconds", "0.1", "--plain", "--record", f"{NAME}.blf"],
        ["conform", *bus, "-c", NAME, "--duration", "0.1s"],
        ["simulate", "BMU", *bus, "-c", NAME, "--seconds", "0.1"],
        ["simulate", "BMU", "--fault", NAME],
        ["send", NAME, *bus],
        ["send", "B2V_ST2", f"soc={NAME}", *bus],
        ["send", "B2V_ST2", f"{NAME}=1", *bus],
        [NAME],
        ["listen", f"--{NAME}"],
    ]
    for text in printed(folder, "swapcan", *commands):
        assert SHOWN in text


def test_a_terminal_gets_colours_and_no_other_sequence(folder: Path) -> None:
    environment = {name: value for name, value in os.environ.items() if name != "NO_COLOR"}
    environment["TERM"] = "xterm"
    words = ("swapcan", "conform", LOG)
    coloured, status = in_terminal(*words, environment=environment, folder=folder)
    plain, _ = in_terminal(*words, environment=environment | {"NO_COLOR": "1"}, folder=folder)
    assert status == 2  # the log is damaged
    assert "\x1b[1;32m" in coloured
    assert lines_of(re.sub(r"\x1b\[[0-9;]*m", "", coloured)) == lines_of(plain)
    assert any(line.startswith(f"Conforms: {SHOWN}") for line in lines_of(plain))
    assert hidden("\n".join(lines_of(plain))) == []


def lines_of(shown: str) -> list[str]:
    """The lines that stay on a terminal, where a slow machine has said how far it is."""
    return [line.rpartition("\r")[2] for line in shown.split("\r\n")]
