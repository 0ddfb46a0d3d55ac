"""What holds for every format of a report."""

from __future__ import annotations

import codecs
import dataclasses
import html
import json
import xml.etree.ElementTree as ET

import pytest
from report.samples import EMPTY, HOSTILE, LINT, PLAIN, RULES, hostile, item

from typedcan.model.errors import ReadError
from typedcan.report.formats import FORMATS, render
from typedcan.report.item import Report
from typedcan.report.rules import RULE_FORMATS, print_rules

every_format = pytest.mark.parametrize("format", FORMATS)


@every_format
@pytest.mark.parametrize(
    "report", [PLAIN, EMPTY, LINT, hostile()], ids=("plain", "empty", "lint", "hostile")
)
def test_every_report_is_text_that_a_file_can_hold(format: str, report: Report) -> None:
    text = render(report, format)
    assert text.encode("utf-8").decode("utf-8") == text
    assert not text or text.endswith("\n")
    assert "\r" not in text


@every_format
def test_a_finding_is_named_with_its_subject_in_every_format(format: str) -> None:
    text = render(PLAIN, format)
    assert "Torque" in text
    assert "signal-scale-same" in text


@every_format
def test_a_change_has_its_fingerprint_file_and_line_in_every_format(format: str) -> None:
    text = render(PLAIN, format)
    for each in PLAIN.items:
        assert each.fingerprint in text
        assert each.where.path in text
    assert "17" in text


@every_format
def test_a_change_of_hundreds_is_one_finding_with_all_its_members(format: str) -> None:
    members = ("Speed", "Torque", "Gear")
    (one, other) = (item(members=members), item(members=("Speed", "Torque")))
    assert one.fingerprint != other.fingerprint
    text = render(dataclasses.replace(PLAIN, items=[one]), format)
    assert one.fingerprint in text
    assert format not in ("json", "html") or "Gear" in text


@every_format
def test_no_character_reaches_a_reader_that_it_cannot_see(format: str) -> None:
    text = render(hostile(), format)
    assert [c for c in text if ord(c) < 32 and c != "\n"] == []
    assert [c for c in text if c in "\x7f\x9b\u202e\u2028\ufffe\ud800"] == []


@every_format
def test_a_report_in_ascii_loses_nothing_where_the_format_can_escape(format: str) -> None:
    plain, ascii_only = (render(hostile(), format, ascii_only=flag) for flag in (False, True))
    assert "→" not in ascii_only
    if format in ("text", "github"):
        assert ascii_only == plain.replace("→", "->")
        return
    assert ascii_only.isascii()
    if format in ("json", "sarif", "gitlab"):
        assert json.loads(ascii_only) == json.loads(plain)
    elif format == "junit":
        assert ET.canonicalize(ascii_only) == ET.canonicalize(plain)
    else:
        assert html.unescape(ascii_only) == html.unescape(plain)


@every_format
def test_only_text_is_coloured_and_only_when_asked(format: str) -> None:
    assert "\x1b" not in render(hostile(), format)
    coloured = render(PLAIN, format, colour=True)
    assert ("\x1b[" in coloured) is (format == "text")


@every_format
def test_order_of_findings_within_a_message_is_kept(format: str) -> None:
    subjects = ["Zulu", "Alpha", "Mike"]
    report = dataclasses.replace(PLAIN, items=[item(subject=subject) for subject in subjects])
    text = render(report, format)
    assert sorted(subjects, key=text.index) == subjects


def test_an_unknown_format_is_refused_with_those_there_are() -> None:
    with pytest.raises(ReadError, match=r"'yaml'.*text, json, markdown, sarif, github"):
        render(PLAIN, "yaml")
    with pytest.raises(ReadError, match=r"'html'.*text, json, markdown"):
        print_rules(RULES, "html")


def test_text_groups_by_message_shows_the_change_and_counts_at_the_end() -> None:
    lines = render(PLAIN, "text").splitlines()
    headings = [line for line in lines[1:-1] if line and not line.startswith(" ")]
    assert headings == ["Engine", "Brake", "The protocol as a whole"]
    assert "wire" in lines[3]
    assert "Speed: factor 0.4 → 0.5" in lines[3]
    for part in ("spec/tables/01-state.yaml:17:9", "signal-scale-same", "sender and receiver"):
        assert part in lines[4]
    assert PLAIN.items[0].fingerprint in lines[4]
    assert "Torque: signal removed (was 8|16@1+)" in lines[5]
    assert "Speed: renamed (0.4 → 0.5)" in "\n".join(lines)
    assert lines[-1] == (
        "4 findings: 2 wire, 1 source, 1 cosmetic; 1 breaks the sender, 2 break the receiver"
    )
    assert render(EMPTY, "text").splitlines()[-1] == "no findings"


def test_a_lint_finding_is_one_sentence_and_its_place() -> None:
    text = render(LINT, "text")
    assert "names ABC, which is no declared node" in text
    assert "→" not in text
    assert "breaks" not in text
    assert "as a whole" not in text


@pytest.mark.parametrize("text", HOSTILE)
def test_text_puts_every_finding_on_as_many_lines_as_any_other(text: str) -> None:
    plain = Report(title="t", items=[item()], rules=RULES)
    nasty = Report(
        title=text, items=[item(subject=text, text=text, old=text, new="1")], rules=RULES
    )
    lengths = [len(render(report, "text").split("\n")) for report in (plain, nasty)]
    assert lengths[0] == lengths[1]


def test_rules_are_listed_in_every_format_in_their_order() -> None:
    names = [rule.id for rule in RULES]
    for name in RULE_FORMATS:
        text = print_rules(RULES, name)
        assert sorted(names, key=text.index) == names
    assert json.loads(print_rules(RULES, "json")) == [dataclasses.asdict(rule) for rule in RULES]
    assert print_rules((), "text") == ""


def test_console_encodings_without_an_arrow_can_print_the_ascii_text() -> None:
    report = dataclasses.replace(PLAIN, title="old.dbc → new.dbc")
    with pytest.raises(UnicodeEncodeError):
        codecs.encode(render(report, "text"), "cp1252")
    assert codecs.encode(render(report, "text", ascii_only=True), "cp1252")


@pytest.mark.parametrize(
    ("format", "longest"), [("text", 1000), ("markdown", 1000), ("github", 3000)]
)
def test_what_people_read_line_by_line_is_cut_and_what_programs_read_is_whole(
    format: str, longest: int
) -> None:
    report = Report(title="t", items=[item(text="x" * 100_000, old="", new="")], rules=())
    assert max(map(len, render(report, format).splitlines())) < longest
    assert "..." in render(report, format)
    for whole in ("json", "sarif", "gitlab", "junit", "html"):
        assert "x" * 100_000 in render(report, whole)
