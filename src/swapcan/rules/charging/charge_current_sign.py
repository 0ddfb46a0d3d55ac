"""While a pack charges its current is negative."""

from __future__ import annotations

import math

import numpy as np

from swapcan.messages import B2V_ST1, B2V_ST2, BmsState, C2B_ACStatus, ChargeState
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.measure.last_known import LastKnown
from typedcan.judge.measure.since import last
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_CURRENT = Tolerance(
    name="charge-current-sign.current",
    value=2.0,
    unit="A",
    text=Text("what a sensor shows where nothing flows", "无电流时传感器的示值误差"),
)
_LOAD = Tolerance(
    name="charge-current-sign.load",
    value=50.0,
    unit="A",
    text=Text(
        "what the truck may draw more while it charges than before; where high voltage is closed "
        "the charger has to give more than both for a judgement",
        "充电期间整车附件比充电前多消耗的电流;高压闭合时,充电机输出超过两者之和才予判断",
    ),
)
_SECONDS = Tolerance(
    name="charge-current-sign.seconds",
    value=1.0,
    unit="s",
    text=Text(
        "for which state and current may differ, as where charging begins or ends",
        "状态与电流允许不一致的时间,如充电开始或结束时",
    ),
)

_CHARGER = Tolerance(
    name="charge-current-sign.charger",
    value=0.75,
    unit="s",
    text=Text(
        "for which a frame of the charger counts: shorter than what is allowed, as it may be gone",
        "充电机报文的有效时间:短于允许时间,因充电机可能已断开",
    ),
)

_SUBJECT = Subject("BMU", "B2V_ST2", "B2V_ST2_Current")

_POSITIVE = Text(
    "{current:.1f} A for {seconds:.2f} s while the state is Charging; charging is negative",
    "充电状态下电流为 {current:.1f} A,持续 {seconds:.2f} s;充电应为负值",
)


class ChargeCurrentSign(LastingWatcher):
    """Judges the current where nothing but a charger can be its cause."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._current, self._load = findings.limit(_CURRENT), findings.limit(_LOAD)
        self._drawn = math.nan  # A, before the pack charged
        self._charger = findings.limit(_CHARGER)
        self._positive = self.lasting(_SUBJECT, findings.limit(_SECONDS), B2V_ST2)

    def feed(self, chunk: Chunk) -> None:
        """Judge the current while the pack charges."""
        series = chunk.sound(B2V_ST2)
        state = LastKnown(chunk.sound(B2V_ST1), series)
        charger = LastKnown(chunk.sound(C2B_ACStatus), series, self._charger)
        current = series.value("current")
        given = np.where(charger.known, charger.value("current_output"), -1.0)
        can_draw = state.raw("bms") != BmsState.HV_OPEN
        charging = state.is_code("chg_st", ChargeState.CHARGING)
        idle = state.known & ~charging & ~np.isnan(current)
        idle[: series.first] = False  # what stands beside the row of before means nothing
        drawn = last(series, idle, current, self._drawn)
        if series.fresh:
            self._drawn = float(drawn[-1])
        enough = given > np.fmax(drawn, 0.0) + self._load
        alone = ~charger.known | (given > self._current)
        judged = charging & ~np.isnan(current)
        judged &= np.where(can_draw, enough & ~np.isnan(drawn), alone)

        def describe(row: int) -> Said:
            return _POSITIVE, {"current": float(current[row])}

        excess = current - self._current
        self._positive.feed(series, judged, excess > 0, describe, excess)


RULE = Rule(
    id="charge-current-sign",
    title=Text("Charging current is negative", "充电电流为负值"),
    purpose=Text(
        "Charging is negative, discharging positive: with another sign state of charge and "
        "energy run the wrong way.",
        "充电为负值,放电为正值;符号相反会使 SOC 与电量统计反向。",
    ),
    clause="Table 1 row 3 (5.1.1)",
    severity=Severity.MUST,
    judges=("BMU",),
    tolerances=(_CURRENT, _LOAD, _SECONDS, _CHARGER),
    watch=ChargeCurrentSign,
)
