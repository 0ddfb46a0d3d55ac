"""How regularly each message came, a plot each."""

from __future__ import annotations

import math

import numpy as np

from typedcan.judge.judgement import Judgement
from typedcan.judge.measure.periods import Periods
from typedcan.judge.report import figures, words
from typedcan.judge.report.facts import allowed_step
from typedcan.report.language import Language
from typedcan.report.markup import Markup, element, lines
from typedcan.report.svg import HEIGHT, WIDTH, Axis, axis, block, framed, level, ticks_up

_TOP = 2.5
"""The plots end at so many periods."""


def periods_section(judgement: Judgement, language: Language) -> Markup:
    """A plot per message that has a period and came; nothing where there is none."""
    if not judgement.periods:
        return Markup("")
    x = axis(0.0, judgement.seconds)
    plots = [
        _plot(each, x, allowed_step(judgement, each.period), language) for each in judgement.periods
    ]
    return element(
        "section",
        element("h3", words.PERIODS.within(language)),
        element("p", words.PERIODS_HELP.within(language), class_="help"),
        element("div", lines(*plots), class_="grid"),
        element("p", words.SECONDS.within(language), class_="axis"),
        class_="card",
    )


def _plot(
    periods: Periods, x: Axis, allowed: tuple[float, float] | None, language: Language
) -> Markup:
    period = periods.period
    y = Axis(0.0, _TOP * period)
    drawing: list[Markup] = []
    if allowed is not None:
        low, high = allowed
        drawing.append(block(x, x.low, x.high, 1 - y.share(high), 1 - y.share(low), "allowed"))
    drawing += [
        level(y, period, "printed"),
        element("path", class_="band", d=_band(periods, x, y)),
        ticks_up(x, periods.time[periods.high > y.high].tolist(), 0, 0.1, "beyond"),
    ]
    return framed(
        _caption(periods, language),
        x,
        drawing,
        heights=[(1.0, "0"), (1 - y.share(period), figures.milliseconds(period))],
        title=periods.message,
    )


def _caption(periods: Periods, language: Language) -> Markup:
    shown = {
        name: figures.milliseconds(value)
        for name, value in (
            ("period", periods.period),
            ("mean", periods.mean),
            ("deviation", periods.deviation),
            ("shortest", periods.shortest),
            ("longest", periods.longest),
        )
    }
    texts = [words.PERIOD] if math.isnan(periods.mean) else [words.PERIOD, words.MEAN, words.RANGE]
    frames = f"{words.FRAMES.within(language)}{words.COLON.within(language)}"
    said = [text.within(language).format(**shown) for text in texts]
    said.append(f"{frames}{figures.count(periods.frames)}")
    return lines(element("b", periods.message), *(element("span", each) for each in said))


def _band(periods: Periods, x: Axis, y: Axis) -> str:
    """The band from the shortest to the longest step, apart where no frame came."""
    time = periods.time
    if not len(time):
        return ""
    steps = np.diff(time)
    width = float(np.median(steps)) if len(steps) else 0.0
    parts = np.split(np.arange(len(time)), np.flatnonzero(steps > 1.5 * width) + 1)
    return "".join(_outline(periods, rows.tolist(), x, y) for rows in parts)


def _outline(periods: Periods, rows: list[int], x: Axis, y: Axis) -> str:
    there = [(x.share(float(periods.time[row])) * WIDTH, row) for row in rows]
    upper = [
        f"{at:.1f} {(1 - y.share(float(periods.high[row]))) * HEIGHT:.1f}" for at, row in there
    ]
    lower = [f"{at:.1f} {(1 - y.share(float(periods.low[row]))) * HEIGHT:.1f}" for at, row in there]
    return f"M{'L'.join([*upper, *reversed(lower)])}Z"
