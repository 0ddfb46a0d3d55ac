"""The probes that are named for the extremes have them."""

from __future__ import annotations

from functools import partial

from swapcan.rules.pack.extremes import PROBE_TEMPERATURES, ExtremesPlace
from swapcan.rules.shared import CYCLES_APART, TOLD_BEFORE
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_DEGREES = Tolerance(
    name="temperature-extremes-place.degrees",
    value=1,
    unit="degC",
    text=Text(
        "how far the temperature of the named probe may be from the extreme in five cycles in a "
        "row, one step",
        "在相邻五个周期中,所报探针温度与极值的允许偏差,即一个步长",
    ),
)
_CYCLES = Tolerance(
    name="temperature-extremes-place.cycles",
    value=1,
    text=Text(
        "for how many cycles in a row it may be further, as a probe may have failed in between",
        "允许连续超出的周期数,因期间探针可能刚刚失效",
    ),
)

RULE = Rule(
    id="temperature-extremes-place",
    title=Text(
        "The probes that are named for the extremes have them",
        "温度极值所在 CSC 编号及位置正确",
    ),
    purpose=Text(
        "Who looks for a hot spot looks where the pack says that it is.",
        "查找过热点时,以电池包上报的编号为准。",
    ),
    clause="Table 7 rows 4 to 7 (5.1.6), Table 10 (5.1.9)",
    severity=Severity.SHOULD,
    errata=("E50",),
    judges=("BMU",),
    tolerances=(_DEGREES, _CYCLES, CYCLES_APART, TOLD_BEFORE),
    watch=partial(ExtremesPlace, kind=PROBE_TEMPERATURES, allowed=_DEGREES, lasting=_CYCLES),
)
