"""The load of each bus beside what the standard asks for, as bars and numbers."""

from __future__ import annotations

from typedcan.judge.judgement import Judgement
from typedcan.judge.measure.load import Load
from typedcan.judge.report import facts, figures, words
from typedcan.report.language import Language
from typedcan.report.markup import Markup, element, lines


def load_section(judgement: Judgement, language: Language) -> Markup:
    """The bars of each channel; nothing where no load was measured."""
    if not judgement.load:
        return Markup("")
    rates = ", ".join(
        f"{rate / 1000:g}" for rate in sorted({load.bit_rate for load in judgement.load})
    )
    return element(
        "section",
        element("h3", words.LOAD.within(language)),
        element("p", words.LOAD_HELP.within(language).format(rate=rates), class_="help"),
        lines(*(_channel(load, language) for load in judgement.load)),
        class_="card",
    )


def _channel(load: Load, language: Language) -> Markup:
    rows = (
        (words.MEASURED, load.measured, load.measured_stuffed, "measured"),
        (words.OWN, load.own, load.own_stuffed, "own"),
        (words.EXPECTED, load.expected, load.expected_stuffed, "expected"),
    )
    bars = [
        element(
            "div",
            element("span", label.within(language), class_="label"),
            _bar(least, most, f"{label.within(language)} {figures.share(least)}", kind),
            element("span", f"{figures.share(least)} – {figures.share(most)}", class_="value"),
            class_="bar",
        )
        for label, least, most, kind in rows
    ]
    name = f"{words.CHANNEL.within(language)} {facts.channel(load, language)}"
    return lines(element("h4", name), element("div", *bars, class_="bars"))


def _bar(least: float, most: float, title: str, kind: str) -> Markup:
    rectangles = [
        element("rect", width=f"{min(max(part, 0.0), 1.0) * 100:.2f}%", height="100%", class_=shade)
        for part, shade in ((most, "most"), (least, "least"))
        if part == part
    ]
    return element("svg", *rectangles, class_=kind, role="img", aria_label=title)
