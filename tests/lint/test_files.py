"""The linter on DBC files: those that the project generates, and those of others."""

from __future__ import annotations

from pathlib import Path

import pytest

from dbcspec.config import Config
from dbcspec.fix import fix_dbc, raw_text
from dbcspec.lint.options import ALL, Options
from dbcspec.lint.rule import Finding, Subject
from dbcspec.lint.run import lint_with
from dbcspec.project import Project
from typedcan.databases.dbc import read_dbc
from typedcan.databases.encoding import find_encoding

FIXTURES = sorted((Path(__file__).parent.parent / "fixtures" / "dbc").glob("*.dbc"))
WAIVED = {"code-labelled", "pgn-unique", "broadcast-receivers"}
"""What the own spec has waivers for."""

NOT_IN_A_DBC = {"source-address"}
"""A DBC file has one address for a node; the spec has two for some."""


def findings(path: Path, text: str | None = None) -> list[Finding]:
    """What all rules say of a file."""
    encoding = find_encoding(path.read_bytes())
    assert encoding
    subject = Subject(
        protocol=read_dbc(path, shown_as=path.name),
        dbc_text=text or raw_text(path.read_bytes(), encoding),
        source=path.name,
    )
    return lint_with(subject, Options(select=(ALL,)))


@pytest.mark.parametrize("path", FIXTURES, ids=lambda path: path.stem)
def test_every_finding_in_a_foreign_file_names_a_line_that_the_file_has(path: Path) -> None:
    lines = path.read_bytes().count(b"\n") + 1
    for finding in findings(path):
        assert finding.where.path == path.name
        assert 1 <= finding.where.line <= lines


@pytest.mark.parametrize("path", FIXTURES, ids=lambda path: path.stem)
def test_a_mended_file_has_no_finding_that_mending_answers(path: Path) -> None:
    encoding = find_encoding(path.read_bytes()) or ""
    mended, _ = fix_dbc(raw_text(path.read_bytes(), encoding))
    assert "dbc-form" not in {each.rule for each in findings(path, mended)}


def test_faults_made_on_purpose_are_found_in_their_lines() -> None:
    path = next(path for path in FIXTURES if path.stem == "overlapping")
    found = {(each.rule, each.where.line, each.subject) for each in findings(path)}
    assert {
        ("signals-overlap", 9, "On_Top"),
        ("signal-inside-message", 10, "Outside"),
        ("range-fits-bits", 11, "Wrong_Range"),
    } <= found


def test_the_generated_files_keep_the_rules_but_for_what_is_waived_or_not_in_a_dbc_file(
    project: Project,
) -> None:
    config: Config = project.config
    paths = sorted((config.root / config.dbc).glob("*.dbc"))
    assert paths
    for path in paths:
        assert {each.rule for each in findings(path)} <= WAIVED | NOT_IN_A_DBC, path.name
