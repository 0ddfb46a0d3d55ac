"""The highest and the lowest temperature are those of the single probes."""

from __future__ import annotations

from functools import partial

from swapcan.rules.pack.extremes import PROBE_TEMPERATURES, ExtremesEqual
from swapcan.rules.shared import CYCLES_APART, TOLD_BEFORE
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_DEGREES = Tolerance(
    name="temperature-extremes-equal.degrees",
    value=1,
    unit="degC",
    text=Text(
        "how far an extreme may lie beyond those of five cycles in a row, one step",
        "极值超出相邻五个周期探针极值的允许量,即一个步长",
    ),
)
_CYCLES = Tolerance(
    name="temperature-extremes-equal.cycles",
    value=1,
    text=Text(
        "for how many cycles in a row it may lie further, as a probe may have failed in between",
        "允许连续超出的周期数,因期间探针可能刚刚失效",
    ),
)

RULE = Rule(
    id="temperature-extremes-equal",
    title=Text(
        "The extremes of the temperatures are those of the single probes",
        "温度极值与各探针温度一致",
    ),
    purpose=Text(
        "The VCU limits driving, recuperation and charging by the extremes; what does not agree "
        "with the probes limits too early or too late.",
        "VCU 以温度极值作为行驶、能量回馈、充电的控制条件;与各探针温度不一致会使限制过早或过晚。",
    ),
    clause="Table 7 rows 1 and 2 (5.1.6), Table 10 (5.1.9)",
    severity=Severity.MUST,
    judges=("BMU",),
    tolerances=(_DEGREES, _CYCLES, CYCLES_APART, TOLD_BEFORE),
    watch=partial(ExtremesEqual, kind=PROBE_TEMPERATURES, allowed=_DEGREES, lasting=_CYCLES),
)
