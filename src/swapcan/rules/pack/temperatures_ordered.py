"""The highest temperature is at least the average, and this at least the lowest."""

from __future__ import annotations

import numpy as np

from swapcan.messages import B2V_ST4
from swapcan.rules.pack.runs import ROUNDING, Runs
from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.series import Series
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_DEGREES = Tolerance(
    name="temperatures-ordered.degrees",
    value=1,
    unit="degC",
    text=Text(
        "how far the average may lie beyond the extremes, one step, as all three are rounded",
        "平均值可超出极值的量,即一个步长,因三者均经取整",
    ),
)

_FIELD = B2V_ST4.FIELDS["avg_temp"]

_BEYOND = Text(
    "the average is {average:.0f} degC, the extremes are {low:.0f} and {high:.0f} degC; allowed: "
    "{allowed:g} degC beyond them",
    "平均值为 {average:.0f} ℃,最低、最高温度为 {low:.0f} ℃、{high:.0f} ℃;允许超出 {allowed:g} ℃",
)


class TemperaturesOrdered(Watcher):
    """Compares the average with the extremes of its frame."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._allowed = findings.limit(_DEGREES)
        self._runs = Runs(findings, Subject(B2V_ST4.SENDER, B2V_ST4.NAME, _FIELD.dbc_name))

    def feed(self, chunk: Chunk) -> None:
        """Judge the new frames."""
        series = chunk.sound(B2V_ST4)
        if not series.fresh:
            return
        average = series.value("avg_temp")
        excess = np.fmax(average - series.value("max_temp"), series.value("min_temp") - average)
        rows = np.flatnonzero(~np.isnan(excess[series.first :])) + series.first
        self._runs.feed(
            series.time[rows],
            series.order[rows],
            excess[rows] > self._allowed + ROUNDING,
            lambda row: self._describe(series, int(rows[row])),
            excess[rows],
        )

    def finish(self, end: LogEnd) -> None:
        """Report what lasts to the end."""
        del end
        self._runs.finish()

    def _describe(self, series: Series, row: int) -> Said:
        return _BEYOND, {
            "average": float(series.value("avg_temp")[row]),
            "low": float(series.value("min_temp")[row]),
            "high": float(series.value("max_temp")[row]),
            "allowed": self._allowed,
        }


RULE = Rule(
    id="temperatures-ordered",
    title=Text(
        "The average temperature lies between the lowest and the highest",
        "电芯温度平均值介于最低值与最高值之间",
    ),
    purpose=Text(
        "An average beyond the extremes shows that one of the three is wrong.",
        "平均值超出极值范围,说明三者之中有误。",
    ),
    clause="Table 7 rows 1 to 3 (5.1.6)",
    severity=Severity.MUST,
    judges=("BMU",),
    tolerances=(_DEGREES,),
    watch=TemperaturesOrdered,
)
