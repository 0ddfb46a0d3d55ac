"""Workflow commands, read back by the documented rules of the runner."""

from __future__ import annotations

import re

import pytest
from report.samples import EMPTY, HOSTILE, PLAIN, RULES, hostile, item

from typedcan.model.errors import Location
from typedcan.report.formats import render
from typedcan.report.item import Report

COMMAND = re.compile(r"::(?P<name>\w+)(?: (?P<properties>[^:]*))?::(?P<data>.*)")
PROPERTIES = {"%0D": "\r", "%0A": "\n", "%3A": ":", "%2C": ",", "%25": "%"}
DATA = {"%0D": "\r", "%0A": "\n", "%25": "%"}


def unescaped(text: str, escapes: dict[str, str]) -> str:
    return re.sub("|".join(escapes), lambda found: escapes[found[0]], text)


def commands(report: Report) -> list[tuple[str, dict[str, str], str]]:
    """Name, properties and data of each command, as the runner takes a line apart."""
    found = []
    for line in render(report, "github").splitlines():
        matched = COMMAND.fullmatch(line)
        assert matched, line
        pairs = (pair.partition("=") for pair in (matched["properties"] or "").split(","))
        properties = {key: unescaped(value, PROPERTIES) for key, _, value in pairs}
        found.append((matched["name"], properties, unescaped(matched["data"], DATA)))
    return found


def test_a_finding_is_shown_at_its_line_with_its_rule() -> None:
    name, properties, data = commands(PLAIN)[0]
    assert name == "error"
    assert properties == {
        "file": "spec/tables/01-state.yaml",
        "line": "17",
        "col": "9",
        "title": "signal-scale-same",
    }
    assert data.startswith("Speed: factor 0.4 → 0.5")
    assert data.endswith(f"breaks sender and receiver [{PLAIN.items[0].fingerprint}]")
    assert render(EMPTY, "github") == ""


def test_gravest_come_first_because_few_are_shown() -> None:
    levels = ["cosmetic", "additive", "source", "wire", "error"]
    report = Report(title="", items=[item("r", level) for level in levels], rules=())
    names = [name for name, _, _ in commands(report)]
    assert names == ["error", "error", "warning", "notice", "notice"]


@pytest.mark.parametrize("text", [text for text in HOSTILE if text.isprintable() and text])
def test_any_text_and_any_path_arrive_as_they_were(text: str) -> None:
    made = item(text, "error", text=text, old="", new="", where=Location(text, 2, 3))
    ((name, properties, data),) = commands(Report(title="", items=[made], rules=()))
    assert name == "error"
    assert properties["file"] == text.replace("\\", "/")
    assert properties["title"] == text
    assert data.startswith(text[:900])


def test_no_text_adds_a_command() -> None:
    report = hostile()
    assert len(commands(report)) == len(report.items)


def test_a_finding_without_a_place_names_no_file() -> None:
    ((_, properties, _),) = commands(
        Report(title="", items=[item(where=Location(""))], rules=RULES)
    )
    assert properties == {"title": "signal-scale-same"}
