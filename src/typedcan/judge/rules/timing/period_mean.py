"""Periodic messages come as often as the standard prints."""

from __future__ import annotations

from functools import partial

from typedcan.judge.findings import Said
from typedcan.judge.measure.presence import nodes_of
from typedcan.judge.measure.spread import Spread
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.rules.timing.by_turns import watch_periods
from typedcan.judge.rules.timing.whole_log import WholeLog
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text
from typedcan.wire.protocol import Protocol

_SHARE = Tolerance(
    name="period-mean.share",
    value=0.1,
    text=Text(
        "of the period, more than any clock is off and less than a wrong period would be",
        "周期的比例:大于时钟误差,小于周期设置错误造成的偏差",
    ),
)
_LEAST = Tolerance(
    name="period-mean.steps",
    value=10,
    text=Text("steps that make a mean worth judging", "计算平均值所需的最少间隔数"),
)

_OFF = Text(
    "{mean:.3g} s from frame to frame in the mean of {count} steps, {period:.3g} s are printed",
    "{count} 个间隔的平均值为 {mean:.3g} s,标准规定周期为 {period:.3g} s",
)


class PeriodMean(WholeLog):
    """Compares the mean step with the period."""

    @property
    def least(self) -> float:
        """Steps that it takes to judge a message."""
        return self.findings.limit(_LEAST)

    def judge(self, period: float, spread: Spread) -> tuple[float, Said | None]:
        """How far off the mean is, in periods."""
        off = abs(spread.mean / period - 1)
        if off <= self.findings.limit(_SHARE):
            return off, None
        return off, (_OFF, {"mean": spread.mean, "count": spread.count, "period": period})


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    return Rule(
        id="period-mean",
        title=Text("Periods are those of the standard", "周期符合标准"),
        purpose=Text(
            "Receivers take a message for lost, and integrate values, by its printed period.",
            "接收方按规定的周期判断报文超时并进行积分计算。",
        ),
        severity=Severity.MUST,
        judges=nodes_of(protocol),
        tolerances=(_SHARE, _LEAST),
        watch=partial(watch_periods, protocol=protocol, make=PeriodMean),
    )
