"""What one command makes of anybody's file every other reads, and what it changes is said."""

from __future__ import annotations

import contextlib
import io
from dataclasses import dataclass
from pathlib import Path

import pytest
from openpyxl import load_workbook

from dbcspec.cli import run
from dbcspec.compare.run import compare
from dbcspec.matrix.write import emit_matrix
from dbcspec.read.doors import open_side
from typedcan.databases.dbc import read_dbc

FILES = Path(__file__).parent.parent / "fixtures" / "loops"
CHANGED = {"names.kcd", "twonode.dbc"}
"""Files of which something is said to be changed: compare tells it too."""

NOT_IN_A_MATRIX = {"attribute-same", "attribute-definition-same"}

FOUND = {"rnode2.dbc"}
"""Files in which lint finds what it finds in what is made of them."""


@dataclass(frozen=True)
class Done:
    """What became of a command."""

    returncode: int
    stdout: str
    stderr: str


def dbcspec(*arguments: object) -> Done:
    with (
        contextlib.redirect_stdout(io.StringIO()) as said,
        contextlib.redirect_stderr(io.StringIO()) as noted,
    ):
        status = run([*map(str, arguments)])
    return Done(status, said.getvalue(), noted.getvalue())


@pytest.mark.parametrize("path", sorted(FILES.iterdir()), ids=lambda path: path.name)
def test_a_file_goes_through_every_command(path: Path, tmp_path: Path) -> None:
    spec, name = tmp_path / "spec", path.stem
    imported = dbcspec("import", path, "--out", spec)
    assert imported.returncode == 0, imported.stderr
    linted = dbcspec("lint", spec)
    assert linted.returncode == (1 if path.name in FOUND else 0), linted.stdout
    assert dbcspec("generate", "-C", spec).returncode == 0
    assert dbcspec("check", "-C", spec).returncode == 0
    made = dbcspec("generate", "--from", path, "--out", tmp_path / "made")
    assert made.returncode == 0, made.stderr
    again = dbcspec("generate", "--from", tmp_path / "made" / f"{name}.xlsx", "--out", tmp_path)
    assert again.returncode == 0, again.stderr
    generated = open_side(str(spec / "dbc" / f"{name}.dbc")).protocol
    original = open_side(str(path)).protocol
    for other in (f"made/{name}.dbc", f"made/{name}.xlsx", f"{name}.dbc", "spec"):
        protocol = open_side(str(tmp_path / other)).protocol
        told = NOT_IN_A_MATRIX if other == f"{name}.dbc" else set[str]()
        assert {each.rule for each in compare(generated, protocol)} <= told, other
        if path.name not in CHANGED:
            assert {each.rule for each in compare(original, protocol)} <= told, other


def test_names_that_are_made_safe_are_said_and_kept(tmp_path: Path) -> None:
    made = dbcspec("generate", "--from", FILES / "names.kcd", "--out", tmp_path)
    assert "'Motor ECU' is Motor_ECU, 'Motor Status' is Motor_Status" in made.stderr
    message = read_dbc(tmp_path / "names.dbc").messages[0]
    assert (message.name, message.sender) == ("Motor_Status", "Motor_ECU")
    kept = [(each.name, each.value) for each in message.signals[0].attributes]
    assert kept == [("OriginalSignalName", "Motor Speed")]


def test_a_node_that_stands_there_twice_is_said(tmp_path: Path) -> None:
    imported = dbcspec("import", FILES / "twonode.dbc", "--out", tmp_path / "spec")
    assert imported.stderr == "dbcspec: the node AA stands there 2 times: once is kept\n"


def test_a_matrix_says_what_it_has_no_room_for(tmp_path: Path) -> None:
    extras = FILES.parent / "dbc" / "extras.dbc"
    made = dbcspec("matrix", "export", extras, "-o", tmp_path / "extras.xlsx")
    assert made.stderr == (
        "dbcspec: not in the matrix: 6 attributes, 9 attribute definitions, 2 signal groups,"
        " 2 environment variables\n"
    )


def test_a_node_called_like_a_column_has_a_heading_of_its_own(tmp_path: Path) -> None:
    (tmp_path / "matrix.xlsx").write_bytes(emit_matrix(read_dbc(FILES / "rnode2.dbc")))
    sheet = load_workbook(tmp_path / "matrix.xlsx")["矩阵 Matrix"]
    assert [cell.value for cell in sheet[1]][-3:] == ["AA", "节点: Receiver", "R"]
    protocol = open_side(str(tmp_path / "matrix.xlsx")).protocol
    assert [each.receivers for each in protocol.messages[0].signals] == [("Receiver",), ("R",)]


def test_an_invalid_code_is_one_by_its_english_label_too(tmp_path: Path) -> None:
    assert dbcspec("import", FILES / "twonode.dbc", "--out", tmp_path / "spec").returncode == 0
    table = tmp_path / "spec" / "tables" / "01-MSG.yaml"
    text = table.read_text("utf-8").replace(
        "    length: 8\n",
        "    length: 8\n    codes: {255: 无效}\n    english_codes: {255: SNA}\n",
        1,
    )
    table.write_text(text, "utf-8")
    standard = tmp_path / "spec" / "standard.yaml"
    standard.write_text(f"{standard.read_text('utf-8')}invalid_labels: [SNA]\n", "utf-8")
    first, second = open_side(str(tmp_path / "spec")).protocol.messages[0].signals
    assert (first.invalid_code, second.invalid_code) == (255, None)
