"""The BMS limits the charging power when the charger says that it is hot."""

from __future__ import annotations

import math

import numpy as np

from swapcan.messages import B2C_Charger, C2B_ACStatus, ChargeControl, ChargerFault
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.measure.last_known import LastKnown
from typedcan.judge.measure.since import last
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_SECONDS = Tolerance(
    name="charge-limited-when-hot.seconds",
    value=5.0,
    unit="s",
    text=Text(
        "from the warning to a lower set point: ten periods of the charger's messages",
        "从充电机过温警告到降低设定值的时间:充电机报文的十个周期",
    ),
)
_SHARE = Tolerance(
    name="charge-limited-when-hot.share",
    value=0.02,
    text=Text(
        "by which the power has to be lower than before the warning; how much is not printed",
        "设定功率应比警告前降低的比例;标准未规定降低多少",
    ),
)

_SUBJECT = Subject("BMU", "B2C_Charger", "B2C_S_CurrentSet")

_NOT_LIMITED = Text(
    "{power:.1f} kW asked for where the charger is too hot, for {seconds:.2f} s; before it was hot "
    "it was {before:.1f} kW",
    "充电机温度过高 {seconds:.2f} s 期间,仍请求 {power:.1f} kW;警告前为 {before:.1f} kW",
)


class ChargeLimitedWhenHot(LastingWatcher):
    """Compares the power that is set under the warning with that before it."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._most = 1 - findings.limit(_SHARE)
        self._asked = self.lasting(_SUBJECT, findings.limit(_SECONDS), B2C_Charger)
        self._before = math.nan

    def feed(self, chunk: Chunk) -> None:
        """Judge the set points under the warning of a charge that began without it."""
        series = chunk.sound(B2C_Charger)
        if not series.fresh:
            return
        charger = LastKnown(chunk.sound(C2B_ACStatus), series)
        hot = charger.is_code("charger_over_temp", ChargerFault.FAULT)
        charges = series.raw("charge_control") == ChargeControl.START_TO_CHARGE
        power = series.value("voltage_set") * series.value("current_set") / 1000
        cool = ~(hot & charges)
        cool[: series.first] = False
        before = last(
            series, cool, np.where(charges & ~hot & (power > 0), power, np.nan), self._before
        )
        self._before = float(before[-1])
        judged = hot & charges & ~np.isnan(before) & ~np.isnan(power)

        def describe(row: int) -> Said:
            return _NOT_LIMITED, {"power": float(power[row]), "before": float(before[row])}

        self._asked.feed(series, judged, power > before * self._most, describe)


RULE = Rule(
    id="charge-limited-when-hot",
    title=Text("Charging is limited when the charger is hot", "充电机过温时限制充电功率"),
    purpose=Text(
        "On the charger's warning that it is too hot the BMS limits the charging power: else the "
        "charger has to break off.",
        "充电机发出温度过高警告时,BMS 应限制充电功率,否则充电机只能中断充电。",
    ),
    clause="Table 19 row 4 (5.4)",
    severity=Severity.SHOULD,
    judges=("BMU",),
    tolerances=(_SECONDS, _SHARE),
    watch=ChargeLimitedWhenHot,
)
