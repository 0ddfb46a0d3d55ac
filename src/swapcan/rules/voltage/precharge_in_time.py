"""A precharge ends."""

from __future__ import annotations

from swapcan.messages import B2V_ST1, BmsState
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_SECONDS = Tolerance(
    name="precharge-in-time.seconds",
    value=10.0,
    unit="s",
    text=Text(
        "for a precharge; the standard names no time, and the resistor is made for a few seconds",
        "预充持续时间;标准未规定,预充电阻按数秒设计",
    ),
)

_SUBJECT = Subject("BMU", "B2V_ST1", "B2V_ST1_BMS")

_LONG = Text("Precharge lasts {seconds:.2f} s", "预充持续 {seconds:.2f} s")


class PrechargeInTime(LastingWatcher):
    """Measures how long each precharge lasts."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._lasts = self.lasting(_SUBJECT, findings.limit(_SECONDS), B2V_ST1)

    def feed(self, chunk: Chunk) -> None:
        """Judge the states Precharge."""
        states = chunk.sound(B2V_ST1)
        precharge = states.raw("bms") == BmsState.PRECHARGE
        self._lasts.feed(states, precharge, precharge, _describe)


def _describe(_: int) -> Said:
    return _LONG, {}


RULE = Rule(
    id="precharge-in-time",
    title=Text("A precharge ends", "预充及时结束"),
    purpose=Text(
        "It ends in HV closed, or in Fail to HV on: the VCU waits for one of them.",
        "预充应以 HV closed 或 Fail to HV on 结束,VCU 在等待其结果。",
    ),
    clause="5.2.1.1, Table 1 row 9 (5.1.1)",
    severity=Severity.SHOULD,
    judges=("BMU",),
    tolerances=(_SECONDS,),
    watch=PrechargeInTime,
)
