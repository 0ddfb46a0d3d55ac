"""The pack could not switch high voltage on."""

from __future__ import annotations

from swapcan.messages import B2V_ST1, BmsState
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.rule import Rule, Severity
from typedcan.report.language import Text

_SUBJECT = Subject("BMU", "B2V_ST1", "B2V_ST1_BMS")

_FAILED = Text(
    "Fail to HV on, for {seconds:.1f} s", "Fail to HV on(上高压失败),持续 {seconds:.1f} s"
)


class HvOnFailed(LastingWatcher):
    """Looks for the state Fail to HV on."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._failed = self.lasting(_SUBJECT, None, B2V_ST1)

    def feed(self, chunk: Chunk) -> None:
        """Tell of the failures."""
        states = chunk.sound(B2V_ST1)
        self._failed.feed(states, None, states.raw("bms") == BmsState.FAIL_TO_HV_ON, _describe)


def _describe(_: int) -> Said:
    return _FAILED, {}


RULE = Rule(
    id="hv-on-failed",
    title=Text("High voltage could not be switched on", "上高压失败"),
    purpose=Text(
        "The pack tells that it did not get to high voltage; alarms beside it may say why.",
        "电池包上报未能完成上高压,原因可参见同时出现的报警。",
    ),
    clause="Table 1 row 9 (5.1.1)",
    severity=Severity.INFO,
    judges=("BMU",),
    watch=HvOnFailed,
)
