"""`swapcan readings`: every erratum and edition, and docs/readings.md is what it prints."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
import yaml

from swapcan import cli
from swapcan.commands.readings import markdown, rules_by_erratum, text
from swapcan.rules import RULES
from typedcan.model.protocol import Alternative, Erratum, Protocol, Variant

Capture = pytest.CaptureFixture[str]


def printed(capsys: Capture, *options: str) -> str:
    assert cli.run(["readings", *options]) == 0
    return capsys.readouterr().out


def yaml_of(path: Path) -> Any:
    return yaml.safe_load(path.read_text("utf-8"))


def cells(page: str) -> dict[str, list[str]]:
    """The rows of the table by their numbers."""
    rows = [line[2:-2].split(" | ") for line in page.splitlines() if line.startswith("| **E")]
    return {re.findall(r"E\d+", row[0])[0]: row for row in rows}


def test_the_page_in_docs_is_current(root: Path, capsys: Capture) -> None:
    page = (root / "docs" / "readings.md").read_text("utf-8")
    assert page == printed(capsys, "--markdown"), "run: swapcan readings --markdown"


def test_the_page_has_every_erratum_and_alternative_of_the_spec(
    root: Path, capsys: Capture
) -> None:
    errata = yaml_of(root / "spec" / "errata.yaml")["errata"]
    rows = cells(printed(capsys, "--markdown"))
    assert list(rows) == [erratum["id"] for erratum in errata]
    for erratum in errata:
        there = re.findall(r"\*\*(E\d+[a-z])\*\*", rows[erratum["id"]][3])
        assert there == [other["id"] for other in erratum.get("alternatives", [])]


def test_the_page_and_the_terminal_have_every_edition_with_its_warnings(
    root: Path, capsys: Capture
) -> None:
    page, shown = printed(capsys, "--markdown"), printed(capsys)
    for path in (root / "spec" / "editions").glob("*/edition.yaml"):
        head = yaml_of(path)
        assert f"### {path.parent.name}" in page
        assert head["title"] in page
        assert f"  {path.parent.name}  {head['english']} ({head['title']})" in shown
        for warning in head["warnings"]:
            assert "".join(warning.split()) in "".join(shown.split())


def test_every_rule_that_rests_on_an_erratum_stands_beside_it(capsys: Capture) -> None:
    rows = cells(printed(capsys, "--markdown"))
    named = 0
    for rule in RULES:
        for number in {*rule.errata, *(each for part in rule.left_open for each in part.errata)}:
            assert re.search(rf"\b{rule.id}\b", rows[number][5]), (rule.id, number)
            named += 1
    assert named > 10


def test_parts_of_a_rule_stand_in_brackets_unless_all_of_it_rests_on_the_erratum() -> None:
    rules = rules_by_erratum(RULES)
    assert "checksum (BMS_TMS_0)" in rules["E47"]
    assert "cell-count-announced" in rules["E50"]
    assert rules["E41"] == ["source-address (V2B_RQData)"]


SMALL = Protocol(
    name="small",
    errata=(
        Erratum(id="E01", kind="typo", place="1", printed="a", reading="b", because="seen"),
        Erratum(
            id="E02",
            kind="gap",
            place="2",
            printed="one | two \x1b[31m",
            reading="one",
            because="it is first",
            source="a bus",
            alternatives=(
                Alternative(id="E02b", reading="two", because="why not", source="a car"),
            ),
        ),
    ),
    variants=(
        Variant(name="E02b", english="two", changes="[]"),
        Variant(
            name="x1",
            is_edition=True,
            title="版",
            english="An edition",
            source="a file",
            date="2020",
            readings=("E02b",),
            warnings=("Mind the gap.",),
            changes="[]",
        ),
    ),
)


def test_the_terminal_shows_what_can_be_chosen_and_nothing_else() -> None:
    lines = list(text(SMALL, {"E02": ["rule-of-two"]}))
    assert lines == [
        "readings (--reading ID); the first of each is the usual one",
        "",
        "  2: one | two \\x1b[31m",
        "    E02   one (a bus)",
        "    E02b  two (a car)",
        "    rules: rule-of-two",
        "",
        "editions (--edition NAME)",
        "",
        "  x1  An edition (版)",
        "    source: a file, 2020",
        "    readings: E02b",
        "    warning: Mind the gap.",
    ]


def test_what_a_spec_says_breaks_no_table() -> None:
    row = next(line for line in markdown(SMALL, {}) if line.startswith("| **E02**"))
    assert row.replace("&#124;", "/").replace("\\|", "/").count("|") == 7
    assert "\x1b" not in row
    assert "**E02** a bus<br>**E02b** a car" in row


def test_no_line_for_the_terminal_is_longer_than_a_hundred_columns(capsys: Capture) -> None:
    lines = printed(capsys).splitlines()
    assert max(map(len, lines)) <= 100
    assert len(lines) > 60
