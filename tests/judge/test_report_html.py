"""The HTML report as browsers parse it."""

from __future__ import annotations

import re
from dataclasses import replace
from xml.etree.ElementTree import Element

import html5lib
import numpy as np
import pytest
from judge.report_samples import (
    EMPTY,
    GOOD,
    HOSTILE,
    MOMENT,
    PLAIN,
    SHARE,
    hostile,
    occurrence,
    result,
    rule,
)

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform import RULES, Judgement, Severity, Tolerance
from typedcan.judge.report import Moment, to_html
from typedcan.judge.report.facts import EXTRA, LEAST, MOST
from typedcan.report.language import Text

ENVIRONMENT = {"swapcan": "1.2.3", "Python": "<3.11>"}


def page(*judgements: Judgement, moments: tuple[Moment, ...] = (), language: str = "en") -> Element:
    """The document, parsed by the rules of browsers; any error in it is an exception."""
    shown = [moments, *[()] * len(judgements)][: len(judgements)]
    text = to_html(judgements, shown, "zh" if language == "zh" else "en", ENVIRONMENT)
    document = html5lib.HTMLParser(namespaceHTMLElements=False, strict=True).parse(text)
    assert isinstance(document, Element)
    return document


def words(element: Element) -> str:
    return " ".join("".join(element.itertext()).split())


def kind(element: Element) -> str:
    """The tag without the namespace that elements of SVG have."""
    return element.tag.rpartition("}")[2]


def of_class(root: Element, name: str) -> list[Element]:
    return [each for each in root.iter() if name in (each.get("class") or "").split()]


@pytest.mark.parametrize(
    "judgements", [(PLAIN, GOOD, EMPTY), (hostile("x"),), ()], ids=("plain", "hostile", "none")
)
def test_nothing_is_fetched_and_nothing_runs(judgements: tuple[Judgement, ...]) -> None:
    document = page(*judgements, moments=(MOMENT,) if judgements else ())
    for element in document.iter():
        assert kind(element) not in {"script", "link", "img", "iframe", "object", "embed", "base"}
        assert not {name for name in element.attrib if name.startswith("on")}
        assert not {"src", "srcset", "action"} & set(element.attrib)
        assert element.get("href", "#").startswith("#")
        assert "url(" not in element.get("style", "")
    style = document.findtext("./head/style") or ""
    assert "url(" not in style
    assert "@import" not in style
    policies = [meta.get("content") for meta in document.iter("meta") if meta.get("http-equiv")]
    assert policies == ["default-src 'none'; style-src 'unsafe-inline'"]


def test_each_log_shows_its_verdict_first() -> None:
    document = page(PLAIN, GOOD, EMPTY)
    banners = [words(each) for each in of_class(document, "verdict")]
    assert banners == [
        "Does not conformdrive.blfDemands of the standard that are broken: 1; by: BMU.",
        "Conformsgood.logNothing that the standard demands is broken in this log.",
        "Could not be judgedempty.logNone of the judged nodes sent a frame of the protocol.",
    ]
    assert document.findtext("./head/title") == "Does not conform: drive.blf"
    targets = {each.get("href") for each in document.iter("a")}
    assert targets == {f"#{each.get('id')}" for each in document.iter("article")}
    assert len(targets) == 3


def test_a_log_says_what_it_is() -> None:
    document = page(PLAIN)
    facts = {
        words(entry[0]): words(entry[1])
        for entry in document.findall(".//article/dl/div")
        if len(entry) == 2
    }
    assert facts == {
        "Begin": "2023-11-14 22:13:20.000 UTC",
        "Length": "10.000 s",
        "Frames": "712of other identifiers: 12",
        "Judged nodes": "BMU, VCU",
        "Seen nodes": "BMU, CHG",
        "SHA-256": "ab" * 32,
        "Damage": PLAIN.damage[0],
    }
    assert "Judged, but not seen: VCU" in words(document)
    assert PROTOCOL.digest in words(document)
    environment = document.find(".//footer")
    assert environment is not None
    assert words(environment) == "Environmentswapcan1.2.3Python<3.11>"


def test_every_rule_is_a_line_that_opens() -> None:
    document = page(PLAIN)
    lines = [
        "|".join(text.strip() for text in each.itertext() if text.strip())
        for each in document.iter("summary")
    ]
    clause, nodes = "5.2.1, Table 14 row 3", "BMU, VCU"
    assert lines == [
        f"{sign}|Title of {id_}|{id_}|{clause}|{severity}|{nodes}|"
        f"Examined|{examined}|Found|{count}|{status}"
        for sign, id_, severity, examined, count, status in (
            ("✕", "answer-in-time", "must", "1,000", "1,234", "failed"),
            ("✕", "period-mean", "should", "1,000", "1", "failed"),
            ("i", "spare-bits", "note", "1,000", "1", "noted"),
            ("✓", "checksum", "must", "1,000", "0", "passed"),
            ("–", "never-seen", "must", "0", "0", "not judged"),
        )
    ]
    assert [each.get("open") for each in document.iter("details")] == ["", None, None, None, None]


def test_an_open_rule_shows_why_within_what_and_when() -> None:
    (body, *_) = of_class(page(PLAIN), "body")
    text = words(body)
    assert "Why there is answer-in-time." in text
    assert "until the answer: 0.75 s answer-in-time.delay" in text
    assert "First, 2.500 sstep of 0.25 s" in text
    assert "Worst, 5.000 sstep of 0.25 s" in text
    rows = [[words(cell) for cell in row] for row in body.iter("tr")][1:]
    assert "|".join(rows[0]) == "2.500|BMU|B2V_ST2_SOC frame 3|step of 0.25 s|2.750|3|250"
    assert "and 1,232 more; see the CSV or JSON report" in text


def test_a_hundred_occurrences_are_listed() -> None:
    many = result(rule("late", Severity.MUST), *(occurrence(i / 10) for i in range(101)))
    document = page(replace(PLAIN, results=(many,)))
    (body,) = of_class(document, "body")
    assert len(list(body.iter("tr"))) == 101
    assert "and 1 more" in words(body)


def test_tolerances_are_listed_with_their_values() -> None:
    document = page(PLAIN)
    tables = [each for each in document.iter("table") if "Value in force" in words(each)]
    (table,) = tables
    rows = [[words(cell) for cell in row] for row in table.iter("tr")]
    assert rows[1:3] == [
        ["answer-in-time.delay", "0.75", "s", "0.5", "until the answer"],
        ["period-mean.share", "0.1", "", "0.1", "share of the period"],
    ]
    assert [row[:4] for row in rows[3:5]] == [
        ["last-known.periods", "3.5", "", "3.5"],
        ["silence.periods", "5", "", "5"],
    ]


def test_the_load_is_a_bar_and_a_number() -> None:
    bars = of_class(page(PLAIN), "bar")
    assert [words(each) for each in bars] == [
        "measured25.0 % – 30.0 %",
        "of the protocol20.0 % – 24.0 %",
        "expected21.0 % – 26.0 %",
    ]
    widths = [[each.get("width") for each in bar.iter() if kind(each) == "rect"] for bar in bars]
    assert widths == [["30.00%", "25.00%"], ["24.00%", "20.00%"], ["26.00%", "21.00%"]]


def numbers(path: Element) -> list[float]:
    return [float(each) for each in re.findall(r"-?\d+(?:\.\d+)?", path.get("d") or "")]


def test_periods_are_drawn_beside_what_is_printed_and_allowed() -> None:
    limits = [
        Tolerance(name=name, value=value, text=Text("x", "某"))
        for name, value in ((LEAST, 0.5), (MOST, 1.5), (EXTRA, 0.01))
    ]
    judgement = replace(PLAIN, results=(result(rule("period-gap", Severity.MUST, *limits)),))
    document = page(judgement)
    (printed,), (allowed,) = of_class(document, "printed"), of_class(document, "allowed")
    # 250 ms from the top to the bottom, which are 0 and 100: 100 ms, 160 ms and 50 ms.
    assert numbers(printed) == [0, 60, 1000]
    assert numbers(allowed) == [0, 36, 1000, 80, 0]
    (band,) = of_class(document, "band")
    assert (band.get("d") or "").count("M") == 2  # apart where no frame came
    assert numbers(band)[:2] == [100, 56]  # the first span, 1 s of 10 s, has 110 ms
    (beyond,) = of_class(document, "beyond")
    assert numbers(beyond)[0] == 700  # 500 ms at 7 s are more than is drawn
    assert "mean 101 ms ± 2 ms" in words(document)
    assert of_class(page(PLAIN), "allowed") == []


def test_the_rules_have_the_tolerances_that_are_drawn() -> None:
    names = {each.name for rule in RULES for each in rule.tolerances}
    assert {LEAST, MOST, EXTRA} <= names


def test_a_message_without_steps_has_no_numbers_for_them() -> None:
    none = np.empty(0)
    single = replace(PLAIN.periods[0], mean=np.nan, frames=1, time=none, low=none, high=none)
    text = words(page(replace(PLAIN, periods=(single,))))
    assert "printed 100 ms Frames: 1" in text
    assert "nan" not in text.lower()


def test_the_moment_of_a_finding_is_drawn() -> None:
    document = page(PLAIN, moments=(MOMENT,))
    (moment,) = of_class(document, "moment")
    spans = of_class(moment, "found")
    assert len(spans) == len(MOMENT.tracks)
    # From 2.5 s to 2.75 s of 1.5 s to 3.75 s.
    left, _, right, *_ = numbers(spans[0])
    assert [left, right] == pytest.approx([444.4, 555.6])
    captions = [words(each) for each in moment.iter("figcaption")]
    assert captions == [
        "B2V_ST2_SOC %",
        "B2V_ST1_BMSState 0 = Off 2 = <On>",
        "B2V_ST2 frames",
        "B2V_ST3 No frame in this span.",
    ]
    curve = of_class(moment, "curve")[0].get("d") or ""
    assert curve.count("M") == 2  # a value that is none breaks it
    assert len(numbers(of_class(moment, "event")[0])) == 2 * 3
    assert "First, 2.500 s" in words(moment)
    assert "Worst, 5.000 s" in words(document)


@pytest.mark.parametrize("text", HOSTILE)
def test_any_text_is_shown_and_never_markup(text: str) -> None:
    calm, nasty = (
        page(
            hostile(word),
            moments=(
                replace(
                    MOMENT,
                    occurrence=hostile(word).results[0].occurrences[0],
                    tracks=tuple(replace(each, name=word, unit=word) for each in MOMENT.tracks),
                ),
            ),
        )
        for word in ("calm", text)
    )
    assert [element.tag for element in calm.iter()] == [element.tag for element in nasty.iter()]
    assert [set(each.attrib) for each in calm.iter()] == [set(each.attrib) for each in nasty.iter()]
    (log,) = of_class(nasty, "log")
    if text.isprintable():
        assert log.text == text
    assert "\x1b" not in to_html([hostile(text)], [()], "en", {text: text})


def test_chinese_readers_get_a_chinese_page() -> None:
    document = page(PLAIN, moments=(MOMENT,), language="zh")
    assert document.get("lang") == "zh-CN"
    assert page(PLAIN).get("lang") == "en"
    assert document.findtext("./head/title") == "不符合标准：drive.blf"
    names = re.compile(r"[A-Za-z]+")
    headings = [words(each) for tag in ("h1", "h2", "h3", "th") for each in document.iter(tag)]
    assert headings
    assert [each for each in headings if names.search(each)] == []
    assert "间隔 0.25 s" in words(document)
    assert "step of" not in words(document)


def test_a_phone_gets_its_own_width_and_the_dark_its_own_colours() -> None:
    document = page(PLAIN)
    metas = {meta.get("name"): meta.get("content") for meta in document.iter("meta")}
    assert metas["viewport"] == "width=device-width, initial-scale=1"
    style = document.findtext("./head/style") or ""
    light, dark = style.split("prefers-color-scheme: dark", 1)
    assert set(re.findall(r"(--[\w-]+):", light)) == set(re.findall(r"(--[\w-]+):", dark))


def test_moments_have_to_be_given_for_every_log() -> None:
    with pytest.raises(ValueError):  # noqa: PT011
        to_html([PLAIN, GOOD], [()], "en", {})


def test_tolerances_of_other_rules_change_no_plot() -> None:
    judgement = replace(PLAIN, results=(result(rule("period-mean", Severity.MUST, SHARE)),))
    assert of_class(page(judgement), "allowed") == []
