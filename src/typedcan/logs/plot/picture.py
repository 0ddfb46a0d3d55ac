"""A plot as one picture, drawn by matplotlib, which is imported only here."""

from __future__ import annotations

import io
from datetime import datetime
from typing import Any

import numpy as np

from typedcan.logs.plot.html import notes
from typedcan.logs.plot.model import GAP_PERIODS, Band, Curve, Heat, Mark, Plot, Spans
from typedcan.model.errors import TypedcanError
from typedcan.shell.printing import printable

_WIDTH, _DPI = 12.0, 150
_CURVE_HEIGHT, _BAND_HEIGHT, _HEAT_HEIGHT = 1.8, 0.32, 2.6
_COLOURS = ("#1f6feb", "#d9730d", "#1a8a5a", "#b83280", "#6b4fc8", "#0e7c86", "#8a6d00", "#c03030")
_MARKS = {
    Mark.GAP: ("#8b8d98", "////"),
    Mark.INVALID: ("#d13415", "\\\\\\\\"),
    Mark.ABNORMAL: ("#9a5cd0", "----"),
}
_BEYOND = "#ff2d6f"
"""For readings beyond the colours of a heat map."""

_LABEL_SHARE = 0.007
"""Share of the width that a letter of a label takes."""


class PictureError(TypedcanError):
    """The package is missing that draws pictures."""


def to_picture(plot: Plot) -> bytes:
    """A PNG; raises `PictureError` where matplotlib is missing."""
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ModuleNotFoundError:
        raise PictureError("a picture needs matplotlib: pip install 'swapcan[plot]'") from None
    heights = [_CURVE_HEIGHT] * len(plot.strips)
    heights += [_BAND_HEIGHT * (len(plot.bands) + 0.6)] if plot.bands else []
    heights += [_HEAT_HEIGHT] * len(plot.heats)
    figure = Figure(figsize=(_WIDTH, sum(heights) + 1.0), dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    # Axes are of no use to type checkers: matplotlib's methods take anything.
    grid = figure.subplots(len(heights), 1, sharex=True, squeeze=False, height_ratios=heights)
    axes: list[Any] = list(grid[:, 0])
    left = iter(axes)
    for curves in plot.strips:
        _draw_curves(next(left), curves)
    if plot.bands:
        _draw_bands(next(left), plot.bands, plot.end - plot.start)
    for heat in plot.heats:
        _draw_heat(figure, next(left), heat)
    axes[0].set_title(_title(plot), loc="left", fontsize=9, wrap=True, parse_math=False)
    axes[-1].set_xlabel("seconds since the log's begin", fontsize=8)
    axes[-1].set_xlim(plot.start, max(plot.end, plot.start + 1e-3))
    for axis in axes:
        axis.tick_params(labelsize=7)
    _explain(figure, plot)
    out = io.BytesIO()
    # No version of the drawing package: the same plot gives the same bytes.
    figure.savefig(out, format="png", metadata={"Software": None})
    return out.getvalue()


def _explain(figure: Any, plot: Plot) -> None:
    """Say what the hatches that occur mean."""
    from matplotlib.patches import Patch

    all_marks = [each.marks for each in plot.curves] + [each.marks for each in plot.bands]
    used = {mark for marks in all_marks for mark in marks}
    samples = [_sample(Patch, mark) for mark in Mark if mark in used]
    if samples:
        figure.legend(handles=samples, loc="outside lower left", ncols=3, fontsize=7, frameon=False)


def _sample(patch: Any, mark: Mark) -> Any:
    colour, hatching = _MARKS[mark]
    label = f"no frame for more than {GAP_PERIODS} periods" if mark is Mark.GAP else mark.value
    return patch(facecolor=f"{colour}22", edgecolor=f"{colour}88", hatch=hatching, label=label)


def _title(plot: Plot) -> str:
    since = ""
    if plot.begin is not None:
        begin = datetime.fromtimestamp(plot.begin).astimezone()
        since = f", begun {begin.isoformat(sep=' ', timespec='seconds')}"
    return "\n".join([plot.title + since, *notes(plot)])


def _draw_curves(axis: Any, curves: list[Curve]) -> None:
    share = 1 / len(curves)
    for number, curve in enumerate(curves):
        colour = _COLOURS[number % len(_COLOURS)]
        at = np.flatnonzero(curve.begins)
        time = np.insert(curve.time, at, np.nan)
        value = np.insert(curve.value, at, np.nan)
        axis.plot(time, value, color=colour, linewidth=0.8, label=_plain(curve.title))
        lone = curve.begins & np.append(curve.begins[1:], np.True_)
        axis.plot(curve.time[lone], curve.value[lone], ".", color=colour, markersize=2)
        _draw_marks(axis, curve.marks, 1 - (number + 1) * share, 1 - number * share)
    axis.set_ylabel(_unit(curves[0].unit), fontsize=8)
    axis.grid(visible=True, color="#e2e4e8", linewidth=0.5)
    axis.legend(loc="upper right", fontsize=7, ncols=4, framealpha=0.8)


def _draw_marks(axis: Any, marks: dict[Mark, Spans], low: float, high: float) -> None:
    """Hatch what has no value, between two shares of the axis's height."""
    for mark, spans in marks.items():
        colour, hatching = _MARKS[mark]
        axis.broken_barh(
            [(begin, end - begin) for begin, end in spans.tolist()],
            (low, high - low),
            transform=axis.get_xaxis_transform(),
            facecolor=f"{colour}22",
            edgecolor=f"{colour}88",
            hatch=hatching,
            linewidth=0.4,
        )


def _draw_bands(axis: Any, bands: tuple[Band, ...], seconds: float) -> None:
    count = len(bands)
    for place, band in enumerate(bands):
        bottom = count - place - 0.9
        for number, (_, named, spans) in enumerate(band.states):
            label = printable(named)
            colour = _COLOURS[(number - 1) % len(_COLOURS)] if number else "#9ba1a9"
            pieces = [(begin, end - begin) for begin, end in spans.tolist()]
            axis.broken_barh(
                pieces, (bottom, 0.8), facecolor=f"{colour}66", edgecolor=colour, linewidth=0.4
            )
            for begin, length in pieces:
                if length > _LABEL_SHARE * seconds * (len(label) + 1):
                    axis.text(
                        begin + _LABEL_SHARE * seconds / 3,
                        bottom + 0.4,
                        label,
                        fontsize=6,
                        va="center",
                        clip_on=True,
                        parse_math=False,
                    )
        _draw_marks(axis, band.marks, bottom / count, (bottom + 0.8) / count)
    axis.set_ylim(0, count)
    axis.set_yticks([count - place - 0.5 for place in range(count)])
    axis.set_yticklabels([_plain(band.title) for band in bands])


def _draw_heat(figure: Any, axis: Any, heat: Heat) -> None:
    from matplotlib import colormaps

    values = _extreme(heat)
    edges, columns = _edges(heat, values)
    rows = np.arange(len(heat.rows) + 1)
    axis.set_facecolor("#d1341555")  # what shows through where there is no value
    gaps = np.stack([heat.spans[:-1, 1], heat.spans[1:, 0]], axis=1)
    gaps = gaps[gaps[:, 1] > gaps[:, 0]]
    low, high = heat.scale()
    colours = colormaps["viridis"].with_extremes(under=_BEYOND, over=_BEYOND)
    mesh = axis.pcolormesh(
        edges, rows, np.ma.masked_invalid(columns).T, cmap=colours, vmin=low, vmax=high
    )
    for begin, end in gaps.tolist():
        axis.axvspan(begin, end, color="white", linewidth=0)
    _draw_marks(axis, {Mark.GAP: gaps}, 0, 1)
    beyond = np.argwhere((columns < low) | (columns > high))
    middles = (edges[1:] + edges[:-1]) / 2
    # As marks, since one column and row is less than can be seen.
    axis.plot(middles[beyond[:, 0]], beyond[:, 1] + 0.5, "s", color=_BEYOND, markersize=2)
    axis.invert_yaxis()
    step = max(1, len(heat.rows) // 12)
    places = range(0, len(heat.rows), step)
    axis.set_yticks([place + 0.5 for place in places])
    axis.set_yticklabels([heat.rows[place] for place in places])
    extend = ("neither", "min", "max", "both")[
        int(np.nanmin(columns, initial=low) < low)
        + 2 * int(np.nanmax(columns, initial=high) > high)
    ]
    bar = figure.colorbar(mesh, ax=axis, pad=0.01, fraction=0.03, extend=extend)
    bar.set_label(_unit(heat.unit), fontsize=8)
    bar.ax.tick_params(labelsize=7)
    axis.set_title(printable(heat.title), loc="left", fontsize=8, parse_math=False)


def _extreme(heat: Heat) -> Any:
    """Of each column and row the value that is farther from the others of the column."""
    middle = (heat.low + heat.high) / 2
    lacking = np.isnan(middle).all(axis=1)
    centre = np.zeros((len(middle), 1))
    centre[~lacking] = np.nanmedian(middle[~lacking], axis=1, keepdims=True)
    return np.where(heat.high - centre >= centre - heat.low, heat.high, heat.low)


def _edges(heat: Heat, values: Any) -> tuple[Any, Any]:
    """Edges of columns, with a column of nothing for each gap."""
    gap = np.flatnonzero(heat.spans[1:, 0] > heat.spans[:-1, 1])
    edges = np.append(heat.spans[:, 0], heat.spans[-1:, 1])
    edges = np.insert(edges, gap + 1, heat.spans[gap, 1])
    return edges, np.insert(values, gap + 1, np.nan, axis=0)


def _plain(text: str) -> str:
    """A label as it is: matplotlib leaves out of legends what begins with an underscore."""
    return printable(text).lstrip("_").replace("$", r"\$")


def _unit(unit: str) -> str:
    return "°C" if unit == "degC" else printable(unit).replace("$", r"\$")
