"""The highest and the lowest cell voltage are those of the single cells."""

from __future__ import annotations

from functools import partial

from swapcan.rules.pack.extremes import CELL_VOLTAGES, ExtremesEqual
from swapcan.rules.shared import CYCLES_APART, TOLD_BEFORE
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_VOLTS = Tolerance(
    name="cell-extremes-equal.volts",
    value=0.005,
    unit="V",
    text=Text(
        "how far an extreme may lie beyond those of five cycles in a row, a few steps of 1 mV",
        "极值超出相邻五个周期单体极值的允许量,即几个 1 mV 步长",
    ),
)
_CYCLES = Tolerance(
    name="cell-extremes-equal.cycles",
    value=1,
    text=Text(
        "for how many cycles in a row it may lie further, as the load may peak between two cycles",
        "允许连续超出的周期数,因两个周期之间负载可能出现尖峰",
    ),
)

RULE = Rule(
    id="cell-extremes-equal",
    title=Text(
        "The extremes of the cell voltages are those of the single cells",
        "单体电压极值与各单体电压一致",
    ),
    purpose=Text(
        "The VCU limits driving, recuperation and charging by the extremes; what does not agree "
        "with the cells limits too early or too late.",
        "VCU 以单体电压极值作为行驶、能量回馈、充电的控制条件;与单体电压不一致会使限制过早或过晚。",
    ),
    clause="Table 6 rows 1 and 3 (5.1.5), Table 9 (5.1.8)",
    severity=Severity.MUST,
    judges=("BMU",),
    tolerances=(_VOLTS, _CYCLES, CYCLES_APART, TOLD_BEFORE),
    watch=partial(ExtremesEqual, kind=CELL_VOLTAGES, allowed=_VOLTS, lasting=_CYCLES),
)
