"""The cells that are named for the extremes have them."""

from __future__ import annotations

from functools import partial

from swapcan.rules.pack.extremes import CELL_VOLTAGES, ExtremesPlace
from swapcan.rules.shared import CYCLES_APART, TOLD_BEFORE
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_VOLTS = Tolerance(
    name="cell-extremes-place.volts",
    value=0.010,
    unit="V",
    text=Text(
        "how far the voltage of the named cell may be from the extreme in five cycles in a row, as "
        "cells are not measured in the same moment",
        "在相邻五个周期中,所报电芯电压与极值的允许偏差,因各单体并非同时采样",
    ),
)
_CYCLES = Tolerance(
    name="cell-extremes-place.cycles",
    value=1,
    text=Text(
        "for how many cycles in a row it may be further, as the load may peak between two cycles",
        "允许连续超出的周期数,因两个周期之间负载可能出现尖峰",
    ),
)

RULE = Rule(
    id="cell-extremes-place",
    title=Text(
        "The cells that are named for the extremes have them",
        "单体电压极值所在 CSC 编号及位置正确",
    ),
    purpose=Text(
        "Who looks for a weak cell looks where the pack says that it is.",
        "查找异常电芯时,以电池包上报的编号为准。",
    ),
    clause="Table 6 rows 4 to 7 (5.1.5), Table 9 (5.1.8)",
    severity=Severity.SHOULD,
    errata=("E50",),
    judges=("BMU",),
    tolerances=(_VOLTS, _CYCLES, CYCLES_APART, TOLD_BEFORE),
    watch=partial(ExtremesPlace, kind=CELL_VOLTAGES, allowed=_VOLTS, lasting=_CYCLES),
)
