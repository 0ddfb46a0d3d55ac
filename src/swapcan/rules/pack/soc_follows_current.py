"""The state of charge changes as the current says."""

from __future__ import annotations

from itertools import groupby
from typing import NamedTuple

import numpy as np

from swapcan.messages import B2V_ST2, B2V_BattInfo1
from swapcan.rules.pack.integral import Integral
from swapcan.rules.pack.runs import ROUNDING
from swapcan.rules.shared import SUMMED_OVER
from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_SECONDS = Tolerance(
    name="soc-follows-current.seconds",
    value=60.0,
    unit="s",
    text=Text("the shortest time that is judged", "参与判定的最短时间"),
)
_CHANGE = Tolerance(
    name="soc-follows-current.change",
    value=3.0,
    unit="%",
    text=Text(
        "the smallest change of SOC, by the current, that is judged; SOC has steps of 0.4 %",
        "参与判定的最小 SOC 变化量(按电流计算);SOC 步长为 0.4 %",
    ),
)
_OFFSET = Tolerance(
    name="soc-follows-current.percent",
    value=2.0,
    unit="%",
    text=Text("how far SOC may be off, whatever the change", "SOC 允许偏差的固定部分"),
)
_SHARE = Tolerance(
    name="soc-follows-current.share",
    value=0.2,
    text=Text(
        "how far it may be off beside, as a share of the change: an aged pack holds less than its "
        "rated capacity",
        "允许偏差中与变化量成比例的部分,因老化电池容量低于额定容量",
    ),
)

_BIN = 10.0
"""Seconds between two points that are kept of a log."""

_JUMP = 2.0
"""% of SOC between two frames; what jumps is another rule's, and begins anew here."""

_OFF = Text(
    "SOC changes by {change:+.1f} %, {ampere_hours:+.2f} Ah discharged of {capacity:.0f} Ah make "
    "{right:+.1f} %; allowed: {allowed:.3g} % off",
    "SOC 变化 {change:+.1f} %,按放电 {ampere_hours:+.2f} Ah、额定容量 {capacity:.0f} Ah 计算应为 "
    "{right:+.1f} %;允许偏差 {allowed:.3g} %",
)


class _Point(NamedTuple):
    """SOC in %, Ah discharged so far, and where: gaps before it, seconds, frame, rows before."""

    gaps: int
    time: float
    order: int
    row: int
    soc: float
    discharged: float


class SocFollowsCurrent(Watcher):
    """Keeps a point every ten seconds, and compares them at the end, when the capacity is known."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._integral = Integral(1, findings)
        self._points: list[_Point] = []
        self._rows = 0
        self._capacities: list[tuple[float, float]] = []

    def feed(self, chunk: Chunk) -> None:
        """Sum up the new frames."""
        self._take_capacity(chunk)
        series = chunk.sound(B2V_ST2)
        if not series.fresh:
            return
        first, soc = series.first, series.value("soc")
        current = series.value("current")[first:, None] / 3600
        jumps = ~(np.abs(np.diff(soc)) <= _JUMP + ROUNDING)
        jumps = jumps if first else np.concatenate([[True], jumps])
        gaps_before = self._integral.gaps
        totals, gaps = self._integral.feed(series.time[first:], current, jumps)
        bins = np.diff(np.floor(series.time / _BIN)) != 0
        new = np.diff(gaps, prepend=gaps_before) != 0
        new[1 - first :] |= bins
        usable = ~(np.isnan(soc[first:]) | np.isnan(current[:, 0]))
        for at in np.flatnonzero(new & usable).tolist():
            row = at + first
            point = _Point(
                int(gaps[at]),
                float(series.time[row]),
                int(series.order[row]),
                self._rows + at,
                float(soc[row]),
                float(totals[at, 0]),
            )
            self._points.append(point)
        self._rows += series.fresh

    def finish(self, end: LogEnd) -> None:
        """Compare, in windows as short as can be judged, and as a whole."""
        del end
        if not self._capacities:
            return
        for _, group in groupby(self._points, key=lambda point: point.gaps):
            self._judge_all(list(group))

    def _take_capacity(self, chunk: Chunk) -> None:
        series = chunk.sound(B2V_BattInfo1)
        if series.fresh:
            capacity = series.value("rate_cap")[series.first :]
            for at in np.flatnonzero(capacity > 0).tolist():
                if not self._capacities or self._capacities[-1][1] != capacity[at]:
                    told = float(series.time[series.first + at]), float(capacity[at])
                    self._capacities.append(told)

    def _judge_all(self, points: list[_Point]) -> None:
        """Judge the points between two gaps."""
        begin, windows, wrong = points[0], 0, False
        for point in points:
            judged = self._judge(begin, point)
            if judged is not None:
                begin = point
                windows += 1
                wrong |= not judged
        if windows > 1 and not wrong:
            self._judge(points[0], points[-1])

    def _judge(self, begin: _Point, end: _Point) -> bool | None:
        """Whether SOC follows the current from point to point; None: cannot be judged."""
        limit = self.findings.limit
        capacity = self._capacity(end.time)
        discharged = end.discharged - begin.discharged
        right = -100 * discharged / capacity
        if end.time - begin.time < limit(_SECONDS) or abs(right) < limit(_CHANGE):
            return None
        change = end.soc - begin.soc
        allowed = limit(_OFFSET) + limit(_SHARE) * abs(right)
        self.findings.examine(B2V_ST2.SENDER)
        if abs(change - right) <= allowed:
            return True
        found = Occurrence(
            subject=Subject(B2V_ST2.SENDER, B2V_ST2.NAME, B2V_ST2.FIELDS["soc"].dbc_name),
            start=begin.time,
            end=end.time,
            order=begin.order,
            frames=end.row - begin.row + 1,
            measure=abs(change - right),
            text=_OFF,
            values={
                "change": change,
                "ampere_hours": discharged,
                "capacity": capacity,
                "right": right,
                "allowed": allowed,
            },
        )
        self.findings.add(found)
        return False

    def _capacity(self, time: float) -> float:
        """The capacity that was told last, or at first, if it was told later."""
        before = [capacity for told, capacity in self._capacities if told <= time]
        return before[-1] if before else self._capacities[0][1]


RULE = Rule(
    id="soc-follows-current",
    title=Text("SOC changes as the current says", "SOC 变化与电流积分一致"),
    purpose=Text(
        "The range that is left is estimated by SOC, which must not drift away from the current.",
        "VCU 以 SOC 估算可续驶里程;SOC 与电流积分不符会造成误判。",
    ),
    clause="Table 1 rows 1 and 3 (5.1.1), Table 13 row 1 (5.1.12)",
    severity=Severity.SHOULD,
    judges=("BMU",),
    tolerances=(_SECONDS, _CHANGE, _OFFSET, _SHARE, SUMMED_OVER),
    watch=SocFollowsCurrent,
)
