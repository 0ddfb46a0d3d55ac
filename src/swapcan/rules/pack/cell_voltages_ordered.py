"""The highest cell voltage is at least the average, and this at least the lowest."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from swapcan.messages import B2V_ST5, B2V_ST6
from swapcan.rules.pack.runs import ROUNDING, Runs
from swapcan.rules.pack.surroundings import Surrounded, Surroundings, rows_of
from swapcan.rules.shared import AROUND
from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_STEP = Tolerance(
    name="cell-voltages-ordered.step",
    value=0.001,
    unit="V",
    text=Text(
        "how far the average may be above the highest in one frame, as both are rounded",
        "同一帧中平均值可高出最大值的量,因两者均经取整",
    ),
)
_VOLTS = Tolerance(
    name="cell-voltages-ordered.volts",
    value=0.005,
    unit="V",
    text=Text(
        "how far the average may be below the lowest, which another frame tells",
        "平均值可低于最小值的量,因两者由不同报文上报",
    ),
)
_AVERAGE = B2V_ST5.FIELDS["avg_ucell"].dbc_name

_TOO_HIGH = Text(
    "the average is {average:.3f} V, the highest cell has {other:.3f} V; allowed: {allowed:g} V "
    "more",
    "平均值为 {average:.3f} V,最高单体为 {other:.3f} V;允许高出 {allowed:g} V",
)
_IN_A_ROW = 2
"""A single frame that was held back is told beside lowest voltages of another moment."""

_TOO_LOW = Text(
    "the average is {average:.3f} V, the lowest cell has {other:.3f} V; allowed: {allowed:g} V "
    "less",
    "平均值为 {average:.3f} V,最低单体为 {other:.3f} V;允许低于 {allowed:g} V",
)


class CellVoltagesOrdered(Watcher):
    """Compares the average with the highest of its frame, and with the lowest told around it."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._step, self._volts = findings.limit(_STEP), findings.limit(_VOLTS)
        self._surroundings = Surroundings(findings)
        self._above = Runs(findings, Subject(B2V_ST5.SENDER, B2V_ST5.NAME, _AVERAGE, "> max"))
        below = Subject(B2V_ST5.SENDER, B2V_ST5.NAME, _AVERAGE, "< min")
        self._below = Runs(findings, below, least=_IN_A_ROW)

    def feed(self, chunk: Chunk) -> None:
        """Judge the new frames."""
        self._take_highest(chunk)
        average, lowest = chunk.sound(B2V_ST5), chunk.sound(B2V_ST6)
        frames = rows_of(average, average.value("avg_ucell"))
        others = rows_of(lowest, lowest.value("min_ucell"))
        self._judge_lowest(self._surroundings.feed(frames, others, chunk.end))

    def finish(self, end: LogEnd) -> None:
        """Judge the rest, and report what lasts to the end."""
        del end
        if left := self._surroundings.finish():
            self._judge_lowest(left)
        self._above.finish()
        self._below.finish()

    def _take_highest(self, chunk: Chunk) -> None:
        series = chunk.sound(B2V_ST5)
        if not series.fresh:
            return
        average, highest = series.value("avg_ucell"), series.value("max_ucell")
        excess = average - highest
        rows = np.flatnonzero(~np.isnan(excess[series.first :])) + series.first
        excess = excess[rows]
        self._above.feed(
            series.time[rows],
            series.order[rows],
            excess > self._step + ROUNDING,
            partial(_describe, _TOO_HIGH, average[rows], highest[rows], self._step),
            excess,
        )

    def _judge_lowest(self, surrounded: Surrounded) -> None:
        frames, around, known = surrounded
        lowest = np.fmin.reduce(around, axis=0)
        excess = lowest - frames.data
        judged = known & ~np.isnan(excess)
        excess = excess[judged]
        self._below.feed(
            frames.time[judged],
            frames.order[judged],
            excess > self._volts + ROUNDING,
            partial(_describe, _TOO_LOW, frames.data[judged], lowest[judged], self._volts),
            excess,
        )


def _describe(
    text: Text, average: NDArray[np.float64], other: NDArray[np.float64], allowed: float, row: int
) -> Said:
    return text, {"average": float(average[row]), "other": float(other[row]), "allowed": allowed}


RULE = Rule(
    id="cell-voltages-ordered",
    title=Text(
        "The average cell voltage lies between the lowest and the highest",
        "单体电压平均值介于最小值与最大值之间",
    ),
    purpose=Text(
        "An average beyond the extremes shows that one of the three is wrong.",
        "平均值超出极值范围,说明三者之中有误。",
    ),
    clause="Table 6 rows 1 to 3 (5.1.5)",
    severity=Severity.MUST,
    judges=("BMU",),
    tolerances=(_STEP, _VOLTS, AROUND),
    watch=CellVoltagesOrdered,
)
