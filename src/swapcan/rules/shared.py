"""What several rules of this standard allow."""

from __future__ import annotations

from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

ANOTHER_PACK = Tolerance(
    name="another-pack.seconds",
    value=3.0,
    unit="s",
    text=Text(
        "without B2V_ST1, after which the pack may be another one: nobody swaps a pack faster",
        "B2V_ST1 中断超过该时间后可能已更换电池包:换电不会更快",
    ),
)
CYCLES_APART = Tolerance(
    name="cycles-apart.periods",
    value=2.5,
    text=Text(
        "Periods between two cycles of readings that are still neighbours: a lost frame costs one",
        "两个数据周期视为相邻的最大间隔(周期的倍数):丢一帧即缺一个周期",
    ),
)
TOLD_BEFORE = Tolerance(
    name="told-before.periods",
    value=2.5,
    text=Text(
        "Periods for which what a pack told counts for the cycles of readings after it",
        "电池包上报的数值对其后数据周期的有效周期数",
    ),
)
AROUND = Tolerance(
    name="around.seconds",
    value=0.25,
    unit="s",
    text=Text(
        "between frames around each other; what is sent every 100 ms has not stopped then",
        "前后各帧之间的最大间隔;周期 100 ms 的报文在此间隔内未中断",
    ),
)
SUMMED_OVER = Tolerance(
    name="summed-over.seconds",
    value=1.0,
    unit="s",
    text=Text(
        "between two values that are summed over time; a longer pause is a gap",
        "按时间积分的两个数值之间的最大间隔,更长则视为中断",
    ),
)
