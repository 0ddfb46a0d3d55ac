"""The charger's current stays within what is set."""

from __future__ import annotations

from swapcan.rules.charging.over_set import OverSet, slack_of
from typedcan.judge.findings import Findings
from typedcan.judge.rule import Rule, Severity
from typedcan.report.language import Text

_SLACK = slack_of("charger-current-limit", "current", 2.0, "A")

_OVER = Text(
    "{given:.1f} A where {set:.1f} A are set; too much for {seconds:.2f} s",
    "输出电流 {given:.1f} A,设定 {set:.1f} A,超限持续 {seconds:.2f} s",
)


class ChargerCurrentLimit(OverSet):
    """Judges the current."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings, _SLACK, ("current_output", "current_set"), _OVER)


RULE = Rule(
    id="charger-current-limit",
    title=Text("Charger current within the set point", "充电机输出电流不超过设定值"),
    purpose=Text(
        "The BMU lowers the set point where the battery is cold, hot or nearly full.",
        "电池低温、高温或接近充满时,BMU 会降低电流设定值。",
    ),
    clause="Table 18 row 2 (5.3), Table 19 row 2 (5.4)",
    severity=Severity.SHOULD,
    judges=("CHG",),
    tolerances=_SLACK.all,
    watch=ChargerCurrentLimit,
)
