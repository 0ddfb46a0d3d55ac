"""The energy counters grow as voltage and current say."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from swapcan.messages import B2V_ST1, B2V_ST2, B2V_ST3, B2V_ElecEnergy
from swapcan.rules.pack.integral import Integral, Numbers
from swapcan.rules.shared import SUMMED_OVER
from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.series import Series, latest
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_ENERGY = Tolerance(
    name="energy-follows-power.energy",
    value=1.0,
    unit="kWh",
    text=Text(
        "the least energy, by voltage and current, that is judged; counters have steps of 0.1 kWh",
        "参与判定的最小电量(按电压和电流计算);计数步长为 0.1 kWh",
    ),
)
_OFFSET = Tolerance(
    name="energy-follows-power.offset",
    value=0.3,
    unit="kWh",
    text=Text("how far a counter may be off, whatever the energy", "计数允许偏差的固定部分"),
)
_SHARE = Tolerance(
    name="energy-follows-power.share",
    value=0.1,
    text=Text(
        "how far it may be off beside, as a share of the energy",
        "允许偏差中与电量成比例的部分",
    ),
)

_JOULES = 3_600_000.0

_OFF = Text(
    "grows by {growth:.1f} kWh, voltage and current make {right:.1f} kWh; allowed: {allowed:.3g} "
    "kWh off",
    "增加 {growth:.1f} kWh,按电压和电流计算应为 {right:.1f} kWh;允许偏差 {allowed:.3g} kWh",
)


@dataclass(frozen=True, slots=True)
class _Point:
    """A frame with the counters, and the energies in kWh up to it.

    ``energies`` are that discharged, that charged, and of the latter that of a charger.
    """

    time: float
    order: int
    gaps: int
    discharged: float
    charged: float
    energies: Numbers


class EnergyFollowsPower(Watcher):
    """Compares the first and the last frame with counters of each part without gaps.

    Whether recuperation counts as charging is not printed: either is right.
    """

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._integral = Integral(3, findings)
        self._begin: _Point | None = None
        self._end: _Point | None = None
        self._frames = 0

    def feed(self, chunk: Chunk) -> None:
        """Sum up the new frames."""
        totals, gaps, order = self._sum_up(chunk)
        counters = chunk.sound(B2V_ElecEnergy)
        if not counters.fresh:
            return
        discharged = counters.value("tot_dischg_energy")
        charged = counters.value("tot_chg_energy")
        for row in range(counters.first, len(counters)):
            at = int(np.searchsorted(order, counters.order[row]))
            point = _Point(
                float(counters.time[row]),
                int(counters.order[row]),
                int(gaps[at]),
                float(discharged[row]),
                float(charged[row]),
                totals[at].copy(),
            )
            self._take_point(point)

    def finish(self, end: LogEnd) -> None:
        """Judge the last part."""
        del end
        self._judge()

    def _sum_up(self, chunk: Chunk) -> tuple[Numbers, NDArray[np.int64], NDArray[np.int64]]:
        """The energies and gaps before the chunk and with each of its frames, and their numbers."""
        before, gaps = self._integral.totals, self._integral.gaps
        series = chunk.sound(B2V_ST2)
        if not series.fresh:
            return before[None], np.array([gaps]), np.empty(0, np.int64)
        power = (
            series.value("current") * _voltage(chunk, series, self._integral.longest) / _JOULES
        )[series.first :]
        charger = _charger_is_there(chunk, series)[series.first :]
        out, into = np.maximum(power, 0.0), np.maximum(-power, 0.0)
        flows = np.stack([out, into, into * charger], axis=1)
        totals, own_gaps = self._integral.feed(series.time[series.first :], flows)
        return (
            np.concatenate([before[None], totals]),
            np.concatenate([[gaps], own_gaps]),
            series.order[series.first :],
        )

    def _take_point(self, point: _Point) -> None:
        if self._begin is None or point.gaps != self._begin.gaps:
            self._judge()
            self._begin, self._frames = point, 0
        self._end = point
        self._frames += 1

    def _judge(self) -> None:
        """Judge the part that has ended."""
        if self._begin is None or self._end is None:
            return
        begin, end = self._begin, self._end
        out, into, from_charger = (end.energies - begin.energies).tolist()
        self._compare("tot_dischg_energy", end.discharged - begin.discharged, out, out)
        self._compare("tot_chg_energy", end.charged - begin.charged, from_charger, into)

    def _compare(self, field: str, growth: float, least: float, most: float) -> None:
        limit = self.findings.limit
        if self._begin is None or self._end is None or most < limit(_ENERGY):
            return
        self.findings.examine(B2V_ElecEnergy.SENDER)
        right = min(max(growth, least), most)
        allowed = limit(_OFFSET) + limit(_SHARE) * right
        if abs(growth - right) <= allowed:
            return
        name = B2V_ElecEnergy.FIELDS[field].dbc_name
        found = Occurrence(
            subject=Subject(B2V_ElecEnergy.SENDER, B2V_ElecEnergy.NAME, name),
            start=self._begin.time,
            end=self._end.time,
            order=self._begin.order,
            frames=self._frames,
            measure=abs(growth - right),
            text=_OFF,
            values={"growth": growth, "right": right, "allowed": allowed},
        )
        self.findings.add(found)


def _voltage(chunk: Chunk, at: Series, longest: float) -> Numbers:
    """The pack's voltage at the frames of another message, NaN where it is too old."""
    series = chunk.sound(B2V_ST3)
    if not len(series):
        return np.full(len(at), np.nan)
    rows = latest(series, at)
    voltage = series.value("upack_batt")[rows]
    voltage[(rows < 0) | (at.time - series.time[rows] > longest)] = np.nan
    return voltage


def _charger_is_there(chunk: Chunk, at: Series) -> NDArray[np.bool_]:
    """Whether the pack tells that a charger is connected."""
    series = chunk.sound(B2V_ST1)
    if not len(series):
        return np.zeros(len(at), np.bool_)
    rows = latest(series, at)
    there: NDArray[np.bool_] = (rows >= 0) & (series.raw("chg_line")[rows] == 1)
    return there


RULE = Rule(
    id="energy-follows-power",
    title=Text(
        "Energy counters grow as voltage and current say", "累计充放电电量与电压电流积分一致"
    ),
    purpose=Text(
        "What a swap costs is read from the counters.",
        "换电计费以累计充放电电量为依据。",
    ),
    clause="Table 4 rows 1 and 2 (5.1.4), Table 1 rows 3 and 4 (5.1.1)",
    severity=Severity.SHOULD,
    judges=("BMU",),
    tolerances=(_ENERGY, _OFFSET, _SHARE, SUMMED_OVER),
    watch=EnergyFollowsPower,
)
