"""The charger's voltage stays within what is set."""

from __future__ import annotations

from swapcan.rules.charging.over_set import OverSet, slack_of
from typedcan.judge.findings import Findings
from typedcan.judge.rule import Rule, Severity
from typedcan.report.language import Text

_SLACK = slack_of("charger-voltage-limit", "voltage", 5.0, "V")

_OVER = Text(
    "{given:.1f} V where {set:.1f} V are set; too much for {seconds:.2f} s",
    "输出电压 {given:.1f} V,设定 {set:.1f} V,超限持续 {seconds:.2f} s",
)


class ChargerVoltageLimit(OverSet):
    """Judges the voltage."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings, _SLACK, ("voltage_output", "voltage_set"), _OVER)


RULE = Rule(
    id="charger-voltage-limit",
    title=Text("Charger voltage within the set point", "充电机输出电压不超过设定值"),
    purpose=Text(
        "The set point is what protects the cells: a charger that goes beyond overcharges them.",
        "电压设定值用于保护电芯,充电机超出会导致过充。",
    ),
    clause="Table 18 row 1 (5.3), Table 19 row 1 (5.4)",
    severity=Severity.SHOULD,
    judges=("CHG",),
    tolerances=_SLACK.all,
    watch=ChargerVoltageLimit,
)
