"""The rules of one log: a line each, which opens to what was found."""

from __future__ import annotations

from collections.abc import Sequence

from typedcan.judge.findings import Occurrence
from typedcan.judge.judgement import Judgement, RuleResult, Status
from typedcan.judge.report import facts, figures, words
from typedcan.judge.report.html.moment_plots import moment_plots
from typedcan.judge.report.moments import Moment
from typedcan.judge.rule import Severity
from typedcan.report.language import Language, Text
from typedcan.report.markup import Markup, element, lines, table, together

_SHOWN = 100
"""Occurrences of a rule that are listed."""

_OPEN = 3
"""Broken demands that are open from the start."""

_SIGNS = {Status.PASSED: "✓", Status.FAILED: "✕", Status.NOTED: "i", Status.NOT_JUDGED: "–"}


def found_section(judgement: Judgement, moments: Sequence[Moment], language: Language) -> Markup:
    """The rules with findings in groups, the gravest first."""
    groups = (
        (words.BROKEN, Severity.MUST, "bad"),
        (words.UNHEEDED, Severity.SHOULD, "warn"),
        (words.NOTED, Severity.INFO, "info"),
    )
    parts: list[Markup] = []
    for heading, severity, kind in groups:
        opened = _OPEN if severity is Severity.MUST else 0
        rules = [
            _rule(judgement, result, moments, language, is_open=place < opened)
            for place, result in enumerate(facts.failed(judgement, severity))
        ]
        parts.append(_group(heading, rules, kind, language))
    return lines(*parts)


def rest_section(judgement: Judgement, language: Language) -> Markup:
    """The rules without findings: those that passed, and those that had nothing to judge."""
    passed, idle = (
        [
            _rule(judgement, result, (), language, is_open=False)
            for result in judgement.of_status(status)
        ]
        for status in (Status.PASSED, Status.NOT_JUDGED)
    )
    return lines(
        _group(words.PASSED, passed, "good", language),
        _group(words.NOT_JUDGED, idle, "none", language),
    )


def _group(heading: Text, rules: Sequence[Markup], kind: str, language: Language) -> Markup:
    """Some rules under a heading; nothing where there are none."""
    if not rules:
        return Markup("")
    size = element("span", str(len(rules)), class_="size")
    return element(
        "section",
        element("h3", heading.within(language), " ", size),
        _headings(language),
        lines(*rules),
        class_=f"card rules {kind}",
    )


def _headings(language: Language) -> Markup:
    """The headings of the columns; each line says for itself what they are, so they are unread."""
    texts = (words.RULE, words.SEVERITY, words.NODES, words.EXAMINED, words.COUNT, words.STATUS)
    cells = [element("span"), *(element("span", text.within(language)) for text in texts)]
    return element("div", *cells, class_="heads", aria_hidden="true")


def _rule(
    judgement: Judgement,
    result: RuleResult,
    moments: Sequence[Moment],
    language: Language,
    *,
    is_open: bool,
) -> Markup:
    rule = result.rule
    reason = facts.reason(judgement, result, language)
    body = [
        element("p", reason, class_="help") if reason else Markup(""),
        element("p", rule.purpose.within(language), class_="purpose"),
        _limits(judgement, result, language),
        _first_and_worst(result, moments, language),
        _occurrences(result, language),
    ]
    return element(
        "details",
        _summary(judgement, result, language),
        element("div", lines(*body), class_="body"),
        open="" if is_open else None,
        class_=f"rule {result.status.name.lower().replace('_', '-')}",
    )


def _summary(judgement: Judgement, result: RuleResult, language: Language) -> Markup:
    rule = result.rule
    status = words.STATUSES[result.status].within(language)
    severity = words.SEVERITIES[result.severity].within(language)
    nodes = words.COMMA.within(language).join(facts.judged_of(judgement, rule))
    name = element(
        "span",
        element("b", rule.title.within(language)),
        element("small", element("code", rule.id), " ", facts.clause(rule, language)),
        class_="name",
    )
    return element(
        "summary",
        element("span", _SIGNS[result.status], class_="sign", aria_hidden="true"),
        name,
        element("span", severity, class_=f"severity {result.severity.name.lower()}"),
        element("span", nodes, class_="nodes"),
        _figure(words.EXAMINED, result.examined, language),
        _figure(words.COUNT, result.count, language),
        element("span", status, class_="status"),
    )


def _figure(label: Text, number: int, language: Language) -> Markup:
    """A number; its label is shown where there are no columns."""
    return element(
        "span",
        element("i", f"{label.within(language)} "),
        figures.count(number),
        class_="n",
    )


def _limits(judgement: Judgement, result: RuleResult, language: Language) -> Markup:
    rows = [
        element(
            "li",
            together(each.text.within(language), words.COLON.within(language)),
            element("b", f"{figures.number(facts.in_force(judgement, each))} {each.unit}".rstrip()),
            " ",
            element("code", each.name),
        )
        for each in result.rule.tolerances
    ]
    return element("ul", *rows, class_="limits") if rows else Markup("")


def _first_and_worst(result: RuleResult, moments: Sequence[Moment], language: Language) -> Markup:
    parts: list[Markup] = []
    for label, found in (
        (words.FIRST, result.first),
        (words.WORST, facts.other_worst(result)),
    ):
        if found is None:
            continue
        own = [each for each in moments if _shows(each, result, found)]
        which = label.within(language)
        if own:
            parts.append(moment_plots(own[0], which, language))
        else:
            parts.append(_sentence(found, which, language))
    return lines(*parts)


def _shows(moment: Moment, result: RuleResult, found: Occurrence) -> bool:
    other = moment.occurrence
    same = (other.subject, other.start, other.order) == (found.subject, found.start, found.order)
    return same and moment.rule == result.rule.id


def _sentence(found: Occurrence, which: str, language: Language) -> Markup:
    heading = words.MOMENT.within(language).format(which=which, start=figures.seconds(found.start))
    return element("h4", heading, element("span", facts.says(found, language)))


def _occurrences(result: RuleResult, language: Language) -> Markup:
    shown = result.occurrences[:_SHOWN]
    if not shown:
        return Markup("")
    headings = (
        words.START,
        words.NODE,
        words.SUBJECT,
        words.WHAT,
        words.END,
        words.FRAMES,
        words.ORDER,
    )
    rows = [
        (
            f"{found.start:,.3f}",
            found.subject.node,
            str(found.subject),
            facts.says(found, language),
            f"{found.end:,.3f}",
            figures.count(found.frames),
            figures.count(found.order),
        )
        for found in shown
    ]
    names = tuple(heading.within(language) for heading in headings)
    more = result.count - len(shown)
    text = words.MORE.within(language).format(count=figures.count(more))
    return lines(
        element("h4", words.OCCURRENCES.within(language), " ", facts.found(result, language)),
        table(names, rows, numeric="0456", wide=3),
        element("p", text, class_="help") if more else Markup(""),
    )
