"""The HTML page as browsers parse it."""

from __future__ import annotations

import re
from xml.etree.ElementTree import Element

import html5lib
import pytest
from report.samples import EMPTY, HOSTILE, PLAIN, RULES, hostile, item

from typedcan.report.formats import render
from typedcan.report.item import Item, Report


def page(report: Report) -> Element:
    """The document, parsed by the rules of browsers; any error in it is an exception."""
    parser = html5lib.HTMLParser(namespaceHTMLElements=False, strict=True)
    document = parser.parse(render(report, "html"))
    assert isinstance(document, Element)
    return document


def of(text: str) -> Item:
    return item(group=text, subject=text, text=f"unit {text} → A", old=text, new="A")


def words(element: Element) -> str:
    return " ".join("".join(element.itertext()).split())


@pytest.mark.parametrize("report", [PLAIN, EMPTY, hostile()], ids=("plain", "empty", "hostile"))
def test_nothing_is_fetched_and_nothing_runs(report: Report) -> None:
    document = page(report)
    for element in document.iter():
        assert element.tag not in {"script", "link", "img", "iframe", "object", "embed", "base"}
        assert not {name for name in element.attrib if name.startswith("on")}
        assert not {"src", "href", "srcset", "action", "style"} & set(element.attrib)
    style = document.findtext("./head/style") or ""
    assert "url(" not in style
    assert "@import" not in style
    policies = [meta.get("content") for meta in document.iter("meta") if meta.get("http-equiv")]
    assert policies == ["default-src 'none'; style-src 'unsafe-inline'"]


def test_each_finding_stands_under_its_message_in_full() -> None:
    document = page(PLAIN)
    headings = [words(heading) for heading in document.iter("h2")]
    assert headings == ["Engine", "Brake", "The protocol as a whole"]
    findings = [words(entry) for entry in document.iter("li")]
    assert len(findings) == len(PLAIN.items)
    for found, made in zip(findings, PLAIN.items, strict=True):
        for part in (made.level, made.subject, made.old, made.new, made.text, made.rule):
            assert " ".join(part.split()) in found
    assert [mark.text for mark in document.iter("del")] == ["0.4", "8|16@1+", "0.4"]
    assert "breaks sender and receiver" in findings[0]
    assert "No findings." in words(page(EMPTY))


@pytest.mark.parametrize("text", HOSTILE)
def test_any_text_is_shown_and_never_markup(text: str) -> None:
    calm, nasty = (
        page(Report(title=word, items=[of(word)], rules=RULES)) for word in ("calm", text or "x")
    )
    assert [element.tag for element in calm.iter()] == [element.tag for element in nasty.iter()]
    if text.isprintable() and text.strip():
        shown = nasty.find(".//del")
        assert shown is not None
        assert shown.text == text


def test_a_box_for_each_level_hides_its_findings_by_style_alone() -> None:
    document = page(PLAIN)
    style = document.findtext("./head/style") or ""
    boxes = [box.get("id") or "" for box in document.iter("input")]
    levels = {made.level for made in PLAIN.items}
    assert set(boxes) == {f"show-{level}" for level in levels}
    assert len(document.findall(".//label/input")) == len(boxes)
    for level in levels:
        rule = f"body:has(#show-{level}:not(:checked)) .{level} {{ display: none; }}"
        assert rule in style
    hidden_whole = [section.get("class") for section in document.iter("section")]
    assert hidden_whole == ["wire", "source", "cosmetic"]


def test_a_phone_gets_its_own_width_and_the_dark_its_own_colours() -> None:
    document = page(PLAIN)
    metas = {meta.get("name"): meta.get("content") for meta in document.iter("meta")}
    assert metas["viewport"] == "width=device-width, initial-scale=1"
    style = document.findtext("./head/style") or ""
    assert "prefers-color-scheme: dark" in style
    light, dark = style.split("prefers-color-scheme: dark", 1)
    assert set(re.findall(r"(--\w+):", light)) == set(re.findall(r"(--(?!tint)\w+):", dark))
