"""The truck draws no more than the pack allows."""

from __future__ import annotations

from swapcan.messages import B2V_ST2
from swapcan.rules.voltage.over_limit import OverLimit, slack_of
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings
from typedcan.judge.rule import Rule, Severity
from typedcan.report.language import Text

_SLACK = slack_of("discharge-limit")

_OVER = Text(
    "{current:.1f} A discharged where {limit:.1f} A are allowed; too much for {seconds:.2f} s",
    "放电电流 {current:.1f} A,允许 {limit:.1f} A,超限持续 {seconds:.2f} s",
)


class DischargeLimit(OverLimit):
    """Judges the current while it is positive."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings, _SLACK, "max_lmt_dis_chg_curr", _OVER)

    def feed(self, chunk: Chunk) -> None:
        """Judge the discharge."""
        series = chunk.sound(B2V_ST2)
        current = series.value("current")
        self.judge(chunk, series, current, current > 0)


RULE = Rule(
    id="discharge-limit",
    title=Text("Discharge within the limit", "放电电流不超过允许值"),
    purpose=Text(
        "The VCU adjusts its current in real time so that it always stays within what the pack "
        "allows at the moment.",
        "VCU 应实时调整放电电流,始终不超过电池当前允许的放电电流。",
    ),
    clause="5.1.4 (SOP), Table 5 row 2",
    severity=Severity.SHOULD,
    errata=("E61",),
    judges=("VCU",),
    tolerances=_SLACK.all,
    watch=DischargeLimit,
)
