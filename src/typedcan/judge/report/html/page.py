"""The whole report as one HTML file that needs no network and no script."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from importlib import resources

from typedcan.judge.judgement import Judgement
from typedcan.judge.report import facts, figures, words
from typedcan.judge.report.html.log import KINDS, log_section, sign
from typedcan.judge.report.moments import Moment
from typedcan.judge.rule import Severity
from typedcan.report.language import Language
from typedcan.report.markup import Markup, element, lines

_LANG = {"en": "en", "zh": "zh-CN"}

_POLICY = "default-src 'none'; style-src 'unsafe-inline'"


def to_html(
    judgements: Sequence[Judgement],
    moments: Sequence[Sequence[Moment]],
    language: Language,
    environment: Mapping[str, str],
) -> str:
    """The page: for phone, desktop and paper, light and dark; every text in it is escaped.

    Parameters
    ----------
    judgements
        The logs, in the order in which they are shown.
    moments
        What `typedcan.judge.report.moments` found, for each of them; may be empty.
    environment
        What judged: names and versions, in the order in which they are shown.

    Raises
    ------
    ValueError
        There are not as many moments as judgements.
    """
    logs = [
        log_section(judgement, own, language, place)
        for place, (judgement, own) in enumerate(zip(judgements, moments, strict=True), 1)
    ]
    body = [
        _top(judgements, language),
        _overview(judgements, language) if len(judgements) > 1 else Markup(""),
        *logs,
        _environment(environment, language),
    ]
    document = element(
        "html",
        _head(judgements, language),
        element("body", element("main", lines(*body))),
        lang=_LANG[language],
    )
    return f"<!DOCTYPE html>\n{document}\n"


def _head(judgements: Sequence[Judgement], language: Language) -> Markup:
    verdict = words.VERDICTS[facts.overall(judgements)].within(language)
    title = f"{verdict}{words.COLON.within(language)}{judgements[0].log}" if judgements else verdict
    head = [
        Markup('<meta charset="utf-8">'),
        Markup(f'<meta http-equiv="Content-Security-Policy" content="{_POLICY}">'),
        Markup('<meta name="viewport" content="width=device-width, initial-scale=1">'),
        Markup('<meta name="color-scheme" content="light dark">'),
        element("title", title),
        element("style", _style()),
    ]
    return element("head", lines(*head))


@cache
def _style() -> Markup:
    text = resources.files("typedcan.judge.report.html").joinpath("page.css").read_text("utf-8")
    return Markup(text)


def _top(judgements: Sequence[Judgement], language: Language) -> Markup:
    heading = element("h1", words.TITLE.within(language))
    protocols = dict.fromkeys(judgement.protocol for judgement in judgements)
    named = [
        element(
            "p",
            words.SPEC.within(language),
            " ",
            protocol.name,
            " ",
            element("code", protocol.digest),
        )
        for protocol in protocols
    ]
    return element("div", heading, *named, class_="top")


def _overview(judgements: Sequence[Judgement], language: Language) -> Markup:
    entries = [
        element(
            "li",
            element(
                "a",
                sign(judgement.verdict),
                element("span", judgement.log, class_="log"),
                element("span", _tally(judgement, language), class_="tally"),
                href=f"#log-{place}",
                class_=KINDS[judgement.verdict],
            ),
        )
        for place, judgement in enumerate(judgements, 1)
    ]
    return element(
        "nav",
        element(
            "h2",
            words.OVERVIEW.within(language),
            " ",
            element("span", str(len(judgements)), class_="size"),
        ),
        element("ol", lines(*entries)),
        class_="card overview",
    )


def _tally(judgement: Judgement, language: Language) -> str:
    verdict = words.VERDICTS[judgement.verdict].within(language)
    counts = [
        f"{words.SEVERITIES[severity].within(language)} {figures.count(number)}"
        for severity in (Severity.MUST, Severity.SHOULD, Severity.INFO)
        if (number := len(facts.failed(judgement, severity)))
    ]
    return " · ".join([verdict, *counts])


def _environment(environment: Mapping[str, str], language: Language) -> Markup:
    items = [
        element("div", element("dt", _name(name, language)), element("dd", text))
        for name, text in environment.items()
    ]
    if not items:
        return Markup("")
    return element(
        "footer",
        element("h2", words.ENVIRONMENT.within(language)),
        element("dl", *items, class_="about"),
        class_="card",
    )


def _name(name: str, language: Language) -> str:
    """What is no proper name has a translation."""
    return words.NAMES[name].within(language) if name in words.NAMES else name
