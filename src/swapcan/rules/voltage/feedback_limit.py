"""The truck feeds back no more than the pack allows."""

from __future__ import annotations

from swapcan.messages import B2V_ST1, B2V_ST2, ChargeLine, ChargeState
from swapcan.rules.voltage.over_limit import OverLimit, slack_of
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings
from typedcan.judge.measure.last_known import LastKnown
from typedcan.judge.rule import Rule, Severity
from typedcan.report.language import Text

_SLACK = slack_of("feedback-limit")

_OVER = Text(
    "{current:.1f} A fed back where {limit:.1f} A are allowed; too much for {seconds:.2f} s",
    "回馈电流 {current:.1f} A,允许 {limit:.1f} A,超限持续 {seconds:.2f} s",
)


class FeedbackLimit(OverLimit):
    """Judges the current while it is negative and no charger can be why."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings, _SLACK, "max_lmt_chg_curr", _OVER)

    def feed(self, chunk: Chunk) -> None:
        """Judge the recuperation."""
        series = chunk.sound(B2V_ST2)
        state = LastKnown(chunk.sound(B2V_ST1), series)
        current = -series.value("current")
        judged = (current > 0) & state.is_code("chg_line", ChargeLine.NOT_CONNECTED)
        judged &= state.raw("chg_st") != ChargeState.CHARGING
        self.judge(chunk, series, current, judged)


RULE = Rule(
    id="feedback-limit",
    title=Text("Recuperation within the limit", "能量回馈电流不超过允许值"),
    purpose=Text(
        "The VCU keeps the recuperated current within what the pack allows at the moment: a cold "
        "or full battery takes little.",
        "VCU 回馈电流不得超过电池当前允许的能量回馈电流;低温或满电的电池可接受的电流很小。",
    ),
    clause="5.1.4 (SOP), Table 5 row 1",
    severity=Severity.SHOULD,
    errata=("E61",),
    judges=("VCU",),
    tolerances=_SLACK.all,
    watch=FeedbackLimit,
)
