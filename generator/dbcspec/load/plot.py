"""The response times of a bus as one SVG picture: what each message waits, against its period."""

from __future__ import annotations

import math
from html import escape
from itertools import count

from dbcspec.load.analysis import BusLoad, MessageLoad
from typedcan.shell.printing import printable

_ROW, _LEFT, _WIDTH, _TOP = 22, 170, 640, 70
_INK, _SOFT, _GOOD, _BAD = "#1b1f24", "#8a94a0", "#2f7d5b", "#b3261e"


def svg(load: BusLoad) -> str:
    """A picture with a logarithmic axis of time: a bar per message, a mark at its period."""
    periods = [float(each.response.stream.period) for each in load.messages] or [1.0]
    bounds = [float(each.response.worst) for each in load.messages if each.response.worst]
    low = 10 ** math.floor(math.log10(min([*bounds, *periods])))
    high = max(10 ** math.ceil(math.log10(max([*bounds, *periods]))), 10 * low)
    axis = _Axis(low, high)
    height = _TOP + _ROW * len(load.messages) + 30
    style = f'font-family="sans-serif" font-size="12" fill="{_INK}"'
    box = f"0 0 {_LEFT + _WIDTH + 30} {height}"
    title = f"Worst-case response times: {escape(printable(load.bus.name))}"
    totals = f"load {float(load.bare):.1%}, with the most stuff bits {float(load.stuffed):.1%}"
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}" {style}>',
        '<rect width="100%" height="100%" fill="#ffffff"/>',
        f'<text x="12" y="24" font-size="16">{title}</text>',
        f'<text x="12" y="44" fill="{_SOFT}">{totals}; bar: longest wait, mark: period</text>',
        *axis.lines(height),
        *(_bar(each, row, axis) for row, each in enumerate(load.messages)),
        "</svg>",
    ]
    return "\n".join(parts) + "\n"


class _Axis:
    """Seconds to columns, logarithmic."""

    def __init__(self, low: float, high: float) -> None:
        self._low = low
        self._decades = math.log10(high / low)

    def at(self, seconds: float) -> float:
        """The column of a time."""
        return _LEFT + _WIDTH * math.log10(seconds / self._low) / self._decades

    def lines(self, height: int) -> list[str]:
        """A line and a label at each power of ten."""
        found: list[str] = []
        for decade in count():
            if decade > self._decades + 0.5:
                return found
            seconds = self._low * 10**decade
            x = self.at(seconds)
            found.append(
                f'<line x1="{x:.1f}" x2="{x:.1f}" y1="{_TOP - 6}" y2="{height - 26}"'
                f' stroke="#e3e7eb"/><text x="{x:.1f}" y="{height - 10}" fill="{_SOFT}"'
                f' text-anchor="middle">{seconds * 1000:g} ms</text>'
            )
        return found


def _bar(each: MessageLoad, row: int, axis: _Axis) -> str:
    y = _TOP + _ROW * row
    name = escape(printable(each.message.name))
    period = axis.at(float(each.response.stream.period))
    worst = each.response.worst
    end = _LEFT + _WIDTH if worst is None else axis.at(float(worst))
    color = _GOOD if each.response.in_time else _BAD
    return (
        f'<text x="{_LEFT - 8}" y="{y + 11}" text-anchor="end">{name}</text>'
        f'<rect x="{_LEFT}" y="{y + 1}" width="{max(end - _LEFT, 1):.1f}" height="12"'
        f' fill="{color}"/><line x1="{period:.1f}" x2="{period:.1f}" y1="{y - 2}" y2="{y + 16}"'
        f' stroke="{_INK}" stroke-width="2"/>'
    )
