"""Plots of what was on the bus around an occurrence."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.report import facts, figures, words
from typedcan.judge.report.moments import Moment, Track
from typedcan.report.language import Language
from typedcan.report.markup import Markup, element, lines, together
from typedcan.report.svg import Axis, axis, block, dots, framed, path, ticks_up

_DOTS = 150
"""Curves with no more points than these show each of them."""

_GAP = 5
"""So many times the usual step between frames break a curve."""


def moment_plots(moment: Moment, which: str, language: Language) -> Markup:
    """The tracks of a moment one below the other, with the span of the occurrence.

    Parameters
    ----------
    which
        What the moment is: the first, or the worst.
    """
    heading = words.MOMENT.within(language).format(
        which=which, start=figures.seconds(moment.occurrence.start)
    )
    said = facts.says(moment.occurrence, language)
    x = axis(moment.begin, moment.end)
    plots = [_track(moment, track, x, language) for track in moment.tracks]
    return element(
        "section",
        element("h4", heading, element("span", said)),
        lines(*plots),
        element("p", words.SECONDS.within(language), class_="axis"),
        class_="moment",
    )


def _track(moment: Moment, track: Track, x: Axis, language: Language) -> Markup:
    found = moment.occurrence
    span = block(x, found.start, found.end, 0, 1, "found")
    name = element("b", track.name)
    if not len(track.time):
        nothing = together(name, " ", words.NO_FRAMES.within(language))
        return framed(nothing, x, [span], title=track.name, kind="strip")
    if track.value is None:
        caption = together(name, " ", words.EVENTS.within(language))
        strokes = ticks_up(x, track.time.tolist(), 0.2, 0.8, "event")
        return framed(caption, x, [span, strokes], title=track.name, kind="strip")
    return _curve(track, track.value, x, span)


def _curve(track: Track, value: NDArray[np.float64], x: Axis, span: Markup) -> Markup:
    there = value[~np.isnan(value)]
    y = axis(*(map(float, (there.min(), there.max())) if len(there) else (0.0, 1.0)), margin=0.12)
    times, values = _broken(track.time, value)
    drawing = [
        span,
        element("path", class_="curve", d=path(x, y, times, values, steps=bool(track.labels))),
        ticks_up(x, track.time[np.isnan(value)].tolist(), 0.88, 1, "none"),
    ]
    if len(value) <= _DOTS:
        drawing.append(dots(x, y, track.time, value))
    return framed(
        together(element("b", track.name), " ", track.unit, _codes(track, there)),
        x,
        drawing,
        heights=_heights(y, there, whole=bool(track.labels)),
        title=track.name,
    )


def _codes(track: Track, there: NDArray[np.float64]) -> str:
    """What the codes that occur mean."""
    codes = sorted({int(code) for code in there}) if track.labels else []
    return "  ".join(f"{code} = {track.labels[code]}" for code in codes if code in track.labels)


def _heights(y: Axis, there: NDArray[np.float64], *, whole: bool) -> list[tuple[float, str]]:
    if not len(there):
        return []
    return [
        (1 - y.share(value), text)
        for value, text in y.ticks(4)
        if not whole or value == round(value)
    ]


def _broken(
    time: NDArray[np.float64], value: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The same points, with a NaN where frames are missing."""
    steps = np.diff(time)
    if len(steps) < 2:
        return time, value
    late = np.flatnonzero(steps > _GAP * max(float(np.median(steps)), 1e-9)) + 1
    return np.insert(time, late, time[late]), np.insert(value, late, np.nan)
