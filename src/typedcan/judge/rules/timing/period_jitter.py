"""Periodic messages come evenly."""

from __future__ import annotations

from functools import partial

from typedcan.judge.findings import Said
from typedcan.judge.measure.presence import nodes_of
from typedcan.judge.measure.spread import Spread, spread_of
from typedcan.judge.measure.steps import Steps
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.rules.timing.by_turns import watch_periods
from typedcan.judge.rules.timing.period_gap import gap_limit
from typedcan.judge.rules.timing.whole_log import WholeLog
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text
from typedcan.wire.protocol import Protocol

_SHARE = Tolerance(
    name="period-jitter.share",
    value=0.25,
    text=Text(
        "of the period: what waiting for a free bus and for a task of the sender may make",
        "周期的比例:等待总线空闲及发送任务调度可能造成的偏差",
    ),
)
_LEAST = Tolerance(
    name="period-jitter.steps",
    value=10,
    text=Text("steps that make a deviation worth judging", "计算标准差所需的最少间隔数"),
)

_UNEVEN = Text(
    "steps deviate by {deviation:.3g} s ({share:.0%} of the period), "
    "at most {limit:.3g} s are allowed",
    "间隔的标准差为 {deviation:.3g} s(周期的 {share:.0%}),最多允许 {limit:.3g} s",
)


class PeriodJitter(WholeLog):
    """Compares the deviation of the steps with the period.

    Lost frames are `period-gap`'s to find: here they would hide how even the others are.
    """

    @property
    def least(self) -> float:
        """Steps that it takes to judge a message."""
        return self.findings.limit(_LEAST)

    def spread(self, period: float, steps: Steps) -> Spread:
        """Of the steps that are no gaps."""
        limit = gap_limit(self.findings, period)
        if steps.spread.longest <= limit:
            return steps.spread
        return spread_of(steps.length[steps.length <= limit])

    def judge(self, period: float, spread: Spread) -> tuple[float, Said | None]:
        """How large the deviation is, in periods."""
        share, limit = spread.deviation / period, self.findings.limit(_SHARE)
        if share <= limit:
            return share, None
        values = {"deviation": spread.deviation, "share": share, "limit": limit * period}
        return share, (_UNEVEN, values)


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    return Rule(
        id="period-jitter",
        title=Text("Periodic frames come evenly", "周期报文间隔均匀"),
        purpose=Text(
            "A control loop closed over the bus needs fresh values at even steps.",
            "通过总线闭环的控制需要间隔均匀的最新数据。",
        ),
        severity=Severity.SHOULD,
        judges=nodes_of(protocol),
        tolerances=(_SHARE, _LEAST),
        watch=partial(watch_periods, protocol=protocol, make=PeriodJitter),
    )
