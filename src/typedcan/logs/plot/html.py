"""A plot as one HTML file with all it needs: data, style and script; nothing is fetched."""

from __future__ import annotations

import base64
import html
import json
import math
import re
from functools import cache
from importlib import resources
from typing import Any

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.plot.model import Band, Curve, Heat, Mark, Plot, Spans

_TICKS = 2**32 - 1
"""The part of the log that is shown has so many units of time."""

_LEVELS = 2**16 - 2
"""The values of a heat map have so many levels at most; one more says that there is none."""

_PLACE = re.compile(r"<!--(\w+)-->")
_SCRIPTS = ("scale.js", "draw.js", "heat.js", "page.js")
_FLOAT32_STEPS = 2**23


def to_html(plot: Plot) -> str:
    """The page: to move, to zoom, and to read values off; on a phone too, light and dark."""
    data = json.dumps(_data(plot), ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    parts = {
        "title": html.escape(plot.title),
        "style": _file("page.css"),
        # Between script tags only "<" is special, and in JSON it stands in strings alone.
        "data": data.replace("<", "\\u003c"),
        "script": "\n".join(_file(name) for name in _SCRIPTS),
    }
    return _PLACE.sub(lambda place: parts[place[1]], _file("page.html"))


@cache
def _file(name: str) -> str:
    return resources.files("typedcan.logs.plot").joinpath(name).read_text("utf-8")


def _data(plot: Plot) -> dict[str, Any]:
    clock = _Clock(plot.start, plot.end)
    strips = [
        {"kind": "curves", "unit": curves[0].unit, "curves": [_curve(c, clock) for c in curves]}
        for curves in plot.strips
    ]
    if plot.bands:
        strips.append({"kind": "bands", "bands": [_band(band, clock) for band in plot.bands]})
    strips += [{"kind": "heat", **_heat(heat, clock)} for heat in plot.heats]
    return {
        "title": plot.title,
        "begin": plot.begin,
        "start": plot.start,
        "end": plot.end,
        "notes": notes(plot),
        "marks": [mark.value for mark in Mark],
        "strips": strips,
    }


def notes(plot: Plot) -> list[str]:
    """What a reader has to know beside what is drawn."""
    found = [f"No frame of {', '.join(plot.absent)}."] if plot.absent else []
    for name, counts in plot.cycles.items():
        if not counts.complete:
            found.append(f"No complete cycle of {name}.")
        elif counts.incomplete:
            found.append(f"{name.capitalize()}: incomplete cycles left out: {counts.incomplete:,}.")
    if plot.refused:
        frames = "1 frame" if plot.refused == 1 else f"{plot.refused:,} frames"
        found.append(f"{frames} with a wrong length or checksum left out.")
    if plot.damage is not None:
        lost = f"{plot.damage.problem}; lost: {plot.damage.lost}"
        found.append(f"The log is damaged at {plot.damage.where}: {lost}.")
    return found


class _Clock:
    """Times as whole numbers from the begin to the end of what is shown."""

    def __init__(self, start: float, end: float) -> None:
        self._start = start
        self._unit = (end - start) / _TICKS or 1.0

    def ticks(self, time: NDArray[np.float64]) -> str:
        """In base 64; times that are beyond the end become the end."""
        ticks = np.clip(np.rint((time - self._start) / self._unit), 0, _TICKS)
        return _packed(ticks.astype("<u4"))


def _curve(curve: Curve, clock: _Clock) -> dict[str, Any]:
    exact = np.abs(curve.value).max(initial=0.0) < _FLOAT32_STEPS * curve.factor
    return {
        "name": curve.title,
        "digits": digits(curve.factor),
        "time": clock.ticks(curve.time),
        "value": _packed(curve.value.astype("<f4" if exact else "<f8")),
        "wide": not exact,
        "begins": _packed(curve.begins.astype(np.uint8)),
        "marks": _marks(curve.marks, clock),
    }


def _band(band: Band, clock: _Clock) -> dict[str, Any]:
    return {
        "name": band.title,
        "states": [
            {"code": code, "label": label, "spans": clock.ticks(spans.ravel())}
            for code, label, spans in band.states
        ],
        "marks": _marks(band.marks, clock),
    }


def _heat(heat: Heat, clock: _Clock) -> dict[str, Any]:
    finite = heat.low[np.isfinite(heat.low)]
    low = float(finite.min(initial=0.0 if not len(finite) else math.inf))
    high = float(np.nanmax(heat.high)) if len(finite) else 1.0
    # Whole steps, so that what is read off is what was sent, unless there are too many of them.
    step = max(heat.step, (high - low) / _LEVELS)
    same = np.array_equal(heat.low, heat.high, equal_nan=True)
    return {
        "name": heat.title,
        "unit": heat.unit,
        "digits": digits(heat.step),
        "rows": heat.rows,
        "spans": clock.ticks(heat.spans.ravel()),
        "base": low,
        "step": step,
        "scale": [round((value - low) / step) for value in heat.scale()],
        "low": _levels(heat.low, low, step),
        "high": None if same else _levels(heat.high, low, step),
        "invalid": _packed(np.packbits(heat.invalid)) if heat.invalid.any() else None,
    }


def _levels(values: NDArray[np.float64], base: float, step: float) -> str:
    levels = np.rint((values - base) / step)
    return _packed(np.where(np.isnan(levels), _LEVELS + 1, levels).astype("<u2"))


def _marks(marks: dict[Mark, Spans], clock: _Clock) -> dict[str, str]:
    return {mark.value: clock.ticks(spans.ravel()) for mark, spans in marks.items()}


def _packed(values: NDArray[Any]) -> str:
    return base64.b64encode(np.ascontiguousarray(values).tobytes()).decode("ascii")


def digits(step: float) -> int:
    """Decimals that a value needs whose smallest step is this one, at most 6."""
    for count in range(7):
        scaled = abs(step) * 10**count
        if math.isclose(scaled, round(scaled), rel_tol=1e-9) and round(scaled):
            return count
    return 6
