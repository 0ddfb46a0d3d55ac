"""A plot as inline SVG that stretches with the page, with its axes as text beside it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from typedcan.report.markup import Markup, element

WIDTH, HEIGHT = 1000.0, 100.0
"""What the axes are mapped to; the drawing is stretched to the space there is."""


@dataclass(frozen=True, slots=True)
class Axis:
    """A range of numbers, never empty."""

    low: float
    high: float

    def share(self, value: float) -> float:
        """Where a value is: 0 at the low end, 1 at the high end, within them."""
        return min(max((value - self.low) / (self.high - self.low), 0.0), 1.0)

    def ticks(self, most: int) -> list[tuple[float, str]]:
        """Round numbers within and their texts, at most so many."""
        least = (self.high - self.low) / most
        power = math.floor(math.log10(least))
        step = next(10.0**power * each for each in (1, 2, 5, 10) if 10.0**power * each >= least)
        digits = max(-math.floor(math.log10(step) + 1e-9), 0)
        first, last = math.ceil(self.low / step - 1e-9), math.floor(self.high / step + 1e-9)
        values = [place * step for place in range(first, last + 1)][:most]
        return [(value, f"{value:,.{digits}f}") for value in values]


def axis(low: float, high: float, *, margin: float = 0.0) -> Axis:
    """An axis over numbers, with a share of them beside; around a single one where they are one."""
    if not high - low > 1e-9 * max(abs(low), abs(high)):
        low, high = low - 0.5, low + 0.5
    room = (high - low) * margin
    return Axis(low - room, high + room)


def path(
    x: Axis, y: Axis, time: NDArray[np.float64], value: NDArray[np.float64], *, steps: bool = False
) -> str:
    """The points as a path, with a gap where a value is NaN.

    Parameters
    ----------
    steps
        Whether a value holds until the next one.
    """
    parts: list[str] = []
    pen_up = True
    for t, v in zip(time.tolist(), value.tolist(), strict=True):
        if math.isnan(v):
            pen_up = True
            continue
        place = f"{x.share(t) * WIDTH:.1f}"
        height = f"{(1 - y.share(v)) * HEIGHT:.1f}"
        if pen_up:
            parts.append(f"M{place} {height}")
        else:
            parts.append(f"H{place}V{height}" if steps else f"L{place} {height}")
        pen_up = False
    return "".join(parts)


def dots(x: Axis, y: Axis, time: NDArray[np.float64], value: NDArray[np.float64]) -> Markup:
    """The points as round dots of a fixed size, however the drawing is stretched."""
    places = [
        f"M{x.share(t) * WIDTH:.1f} {(1 - y.share(v)) * HEIGHT:.1f}h0"
        for t, v in zip(time.tolist(), value.tolist(), strict=True)
        if not math.isnan(v)
    ]
    return element("path", class_="dots", d="".join(places))


def ticks_up(x: Axis, time: Iterable[float], low: float, high: float, kind: str) -> Markup:
    """Upright strokes between two heights, which are shares from the top."""
    places = [f"M{x.share(t) * WIDTH:.1f} {low * HEIGHT:.1f}V{high * HEIGHT:.1f}" for t in time]
    return element("path", class_=kind, d="".join(places))


def block(x: Axis, begin: float, end: float, top: float, bottom: float, kind: str) -> Markup:
    """A filled span of time between two heights, which are shares from the top."""
    left, right = x.share(begin) * WIDTH, x.share(end) * WIDTH
    # A path: unlike a rectangle it has an outline where it is no wider than a moment.
    sides = f"M{left:.1f} {top * HEIGHT:.1f}H{right:.1f}V{bottom * HEIGHT:.1f}H{left:.1f}Z"
    return element("path", class_=kind, d=sides)


def level(y: Axis, value: float, kind: str) -> Markup:
    """A line across at a value."""
    return element("path", class_=kind, d=f"M0 {(1 - y.share(value)) * HEIGHT:.1f}H{WIDTH:.0f}")


def framed(
    caption: str,
    x: Axis,
    drawing: Sequence[Markup],
    *,
    heights: Sequence[tuple[float, str]] = (),
    title: str,
    kind: str = "",
) -> Markup:
    """The figure: caption, drawing, and texts at the axes.

    Parameters
    ----------
    caption
        What is above it, markup or text.
    heights
        Texts at the left, each with its height as a share from the top.
    title
        What the drawing shows, for those who cannot see it.
    kind
        Class of the figure.
    """
    svg = element(
        "svg",
        *drawing,
        viewBox=f"0 0 {WIDTH:.0f} {HEIGHT:.0f}",
        preserveAspectRatio="none",
        role="img",
        aria_label=title,
    )
    left = [element("span", text, style=f"top:{share * 100:.1f}%") for share, text in heights]
    below = [
        element("span", text, style=f"left:{x.share(tick) * 100:.2f}%") for tick, text in x.ticks(5)
    ]
    return element(
        "figure",
        element("figcaption", caption),
        element("div", *left, class_="y"),
        element("div", svg, class_="drawing"),
        element("div", *below, class_="x"),
        class_=f"plot {kind}".rstrip(),
    )
