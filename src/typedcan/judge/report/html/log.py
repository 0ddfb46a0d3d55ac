"""All about one log: the verdict, what it is, and what was found."""

from __future__ import annotations

from collections.abc import Sequence

from typedcan.judge.judgement import Judgement, Verdict
from typedcan.judge.report import facts, figures, words
from typedcan.judge.report.html.load import load_section
from typedcan.judge.report.html.periods import periods_section
from typedcan.judge.report.html.rules import found_section, rest_section
from typedcan.judge.report.moments import Moment
from typedcan.report.language import Language, Text
from typedcan.report.markup import Markup, element, lines, table, together

KINDS = {Verdict.CONFORMS: "good", Verdict.VIOLATES: "bad", Verdict.NOT_JUDGED: "none"}
"""Classes of verdicts."""

_SIGNS = {Verdict.CONFORMS: "M5 13l5 5L19 7", Verdict.VIOLATES: "M6 6l12 12M18 6L6 18"}


def log_section(
    judgement: Judgement, moments: Sequence[Moment], language: Language, place: int
) -> Markup:
    """The part of one log; it can be linked to by its place, which counts from 1."""
    parts = [
        _banner(judgement, language),
        _about(judgement, language),
        found_section(judgement, moments, language),
        periods_section(judgement, language),
        load_section(judgement, language),
        rest_section(judgement, language),
        _tolerances(judgement, language),
    ]
    return element("article", lines(*parts), id=f"log-{place}")


def sign(verdict: Verdict) -> Markup:
    """What a verdict looks like."""
    line = element("path", d=_SIGNS.get(verdict, "M7 12h10"))
    return element("svg", line, viewBox="0 0 24 24", class_="mark", aria_hidden="true")


def _banner(judgement: Judgement, language: Language) -> Markup:
    verdict = words.VERDICTS[judgement.verdict].within(language)
    return element(
        "header",
        sign(judgement.verdict),
        element(
            "div",
            element("h2", verdict),
            element("p", judgement.log, class_="log"),
            element("p", facts.why(judgement, language)),
        ),
        class_=f"verdict {KINDS[judgement.verdict]}",
    )


def _about(judgement: Judgement, language: Language) -> Markup:
    frames = sum(judgement.frames.values())
    others = judgement.frames.get("", 0)
    shown: list[tuple[Text, str | Markup]] = [
        (words.BEGIN, _begin(judgement, language)),
        (words.LENGTH, figures.seconds(judgement.seconds)),
        (words.FRAMES, figures.count(frames)),
        (words.JUDGED, _names(judgement.nodes, language)),
        (words.SEEN, _names(judgement.seen, language)),
    ]
    if others:
        text = words.OTHERS.within(language).format(count=figures.count(others))
        shown[2] = (words.FRAMES, together(figures.count(frames), element("small", text)))
    if judgement.digest:
        shown.append((words.DIGEST, element("code", judgement.digest)))
    shown += [(words.DAMAGE, element("strong", line)) for line in judgement.damage]
    items = [
        element("div", element("dt", name.within(language)), element("dd", text))
        for name, text in shown
    ]
    missing = facts.unseen(judgement)
    absent = words.UNSEEN.within(language).format(nodes=_names(missing, language))
    return lines(
        element("dl", *items, class_="card about"),
        element("p", absent, class_="card absent") if missing else Markup(""),
    )


def _begin(judgement: Judgement, language: Language) -> str:
    begin = figures.utc(judgement.begin)
    if not begin:
        return words.NO_DATE.within(language)
    day, time = begin.removesuffix("Z").split("T")
    return f"{day} {time[:-3]} UTC"


def _names(names: Sequence[str], language: Language) -> str:
    return words.COMMA.within(language).join(names) or words.NONE.within(language)


def _tolerances(judgement: Judgement, language: Language) -> Markup:
    rows = [
        (
            element("code", each.name),
            figures.number(facts.in_force(judgement, each)),
            each.unit,
            figures.number(each.value),
            each.text.within(language),
        )
        for each in facts.tolerances(judgement)
    ]
    headings = (words.TOLERANCE, words.VALUE, words.UNIT, words.DEFAULT, words.MEANING)
    names = tuple(heading.within(language) for heading in headings)
    return element(
        "section",
        element("h3", words.TOLERANCES.within(language)),
        table(names, rows, numeric="13", wide=4),
        class_="card",
    )
