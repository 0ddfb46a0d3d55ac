"""Markdown as an independent renderer of it shows it."""

from __future__ import annotations

import dataclasses
from html.parser import HTMLParser

import pytest
from markdown_it import MarkdownIt
from report.samples import EMPTY, HOSTILE, LINT, PLAIN, RULES, hostile, item

from typedcan.report.formats import render
from typedcan.report.item import Report
from typedcan.report.rules import print_rules

ALLOWED = {"h3", "h4", "p", "strong", "table", "thead", "tbody", "tr", "th", "td"}
FOLDING = {"details", "summary", "b"}


class Page(HTMLParser):
    """The tags of rendered Markdown and the text of its table cells, row by row."""

    def __init__(self, markdown: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.rows: list[list[str]] = []
        self.feed(MarkdownIt("gfm-like", {"linkify": False}).render(markdown))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        if tag == "tr":
            self.rows.append([])
        elif tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_data(self, data: str) -> None:
        if self.rows and self.rows[-1]:
            self.rows[-1][-1] += data.rstrip("\n")


def test_each_message_has_a_table_below_one_line_of_summary() -> None:
    text = render(PLAIN, "markdown")
    page = Page(text)
    assert "**4 findings: 2 wire, 1 source, 1 cosmetic. 1 breaks the sender, 2 break" in text
    assert page.tags.count("table") == len({item.group for item in PLAIN.items})
    (*cells, promise, where, fingerprint) = page.rows[1]
    assert where == "spec/tables/01-state.yaml:17:9"
    assert fingerprint == PLAIN.items[0].fingerprint
    assert cells == ["wire", "Speed", "factor 0.4 → 0.5", "sender and receiver"]
    assert promise == "signal-scale-same"
    assert "No findings." in render(EMPTY, "markdown")
    assert "table" not in Page(render(EMPTY, "markdown")).tags


def test_lint_findings_have_their_place_and_no_columns_of_change() -> None:
    page = Page(render(LINT, "markdown"))
    assert page.rows[0] == ["where", "finding", "rule"]
    assert page.rows[1][0] == "spec/tables/01-state.yaml:17:9"


@pytest.mark.parametrize("text", HOSTILE)
def test_a_cell_shows_any_text_as_it_is_and_makes_no_cell_or_tag_of_it(text: str) -> None:
    report = Report(
        title="t", items=[item(subject=text, text=f"unit {text}", old="", new="")], rules=RULES
    )
    page = Page(render(report, "markdown"))
    assert set(page.tags) <= ALLOWED
    assert [len(row) for row in page.rows] == [7, 7]
    if text.isprintable() and len(text) < 300:
        assert page.rows[1][1] == text.strip()
        assert page.rows[1][2] == f"unit {text}".strip()


def test_a_long_report_is_folded_and_still_made_of_whole_tables() -> None:
    report = hostile(tuple(text for text in HOSTILE if len(text) < 300))
    page = Page(render(report, "markdown"))
    assert set(page.tags) <= ALLOWED | FOLDING
    assert page.tags.count("details") == len({item.group for item in report.items})
    assert {len(row) for row in page.rows} == {7}
    assert len(page.rows) == len(report.items) + page.tags.count("table")


def test_a_report_that_is_too_long_for_a_comment_says_what_it_leaves_out() -> None:
    items = [item(group=f"M{number}", text="x" * 250) for number in range(400)]
    text = render(dataclasses.replace(PLAIN, items=items), "markdown")
    assert len(text) < 65_000
    shown = len(Page(text).rows) // 2
    assert f"{400 - shown} more findings would not fit here" in text


def test_a_mention_in_a_text_calls_nobody() -> None:
    report = Report(title="@boss", items=[item(subject="@boss", text="see #12")], rules=RULES)
    text = render(report, "markdown")
    assert "@boss" not in text
    assert "#12" not in text


def test_rules_make_a_table() -> None:
    page = Page(print_rules(RULES, "markdown"))
    assert page.rows[1:] == [[rule.id, rule.level, rule.purpose] for rule in RULES]
