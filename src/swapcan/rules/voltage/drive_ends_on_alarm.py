"""The VCU does something about an alarm of the highest level."""

from __future__ import annotations

import math

import numpy as np

from swapcan.messages import B2V_ST1, B2V_ST2, V2B_CMD, FaultLevel, HvCommand
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.measure.last_known import LastKnown
from typedcan.judge.measure.since import last
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_SECONDS = Tolerance(
    name="drive-ends-on-alarm.seconds",
    value=5.0,
    unit="s",
    text=Text(
        "from the alarm to a lower current; the standard names no time, and a truck that moves "
        "should not lose its drive at once",
        "从报警到降低电流的时间;标准未规定,行驶中的车辆不宜立即失去动力",
    ),
)
_CURRENT = Tolerance(
    name="drive-ends-on-alarm.current",
    value=20.0,
    unit="A",
    text=Text(
        "that what is no drive may draw, such as steering and air compressor",
        "非驱动负载(如转向、空压机)可能消耗的电流",
    ),
)
_SHARE = Tolerance(
    name="drive-ends-on-alarm.share",
    value=0.5,
    text=Text(
        "of the current before the alarm that counts as lowered; how much is not printed",
        "降至报警前电流的该比例视为已降低电流;标准未规定降低多少",
    ),
)

_SUBJECT = Subject("VCU", "B2V_ST2", "B2V_ST2_Current")

_DRIVES_ON = Text(
    "{current:.1f} A drawn under an alarm of level 3, for {seconds:.2f} s, with the command HV On",
    "三级报警期间上高压指令保持,放电电流 {current:.1f} A,持续 {seconds:.2f} s",
)


class DriveEndsOnAlarm(LastingWatcher):
    """Judges the current under an alarm of level 3 while the VCU keeps high voltage on."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._least, self._share = findings.limit(_CURRENT), findings.limit(_SHARE)
        self._goes_on = self.lasting(_SUBJECT, findings.limit(_SECONDS), B2V_ST2)
        self._before = math.nan

    def feed(self, chunk: Chunk) -> None:
        """Judge the discharge."""
        series = chunk.sound(B2V_ST2)
        if not series.fresh:
            return
        state = LastKnown(chunk.sound(B2V_ST1), series)
        command = LastKnown(chunk.sound(V2B_CMD), series)
        alarm = state.is_code("fault_levl", FaultLevel.LEVEL3_MOST_SEVERE_FAULT)
        current = series.value("current")
        calm = ~alarm
        calm[: series.first] = False
        before = last(series, calm, current, self._before)
        self._before = float(before[-1])
        judged = alarm & command.is_code("hv_on_off", HvCommand.HV_ON) & ~np.isnan(current)
        wrong = (current > self._least) & ~(current <= before * self._share)

        def describe(row: int) -> Said:
            return _DRIVES_ON, {"current": float(current[row])}

        self._goes_on.feed(series, judged, wrong, describe, np.where(wrong, current, 0.0))


RULE = Rule(
    id="drive-ends-on-alarm",
    title=Text("The VCU reacts to the highest alarm", "VCU 对最高级报警作出响应"),
    purpose=Text(
        "The VCU acts on the alarms of the BMS: it lowers the current, or stops. What it does at "
        "which level is its own strategy, but it does not drive on under level 3 as before.",
        "VCU 接收到 BMS 告警后应按策略处理,如降低电流或停止放电。"
        "各级的处理策略由 VCU 确定,但三级报警时不应照常行驶。",
    ),
    clause="5.1.11, Table 1 row 15 (5.1.1)",
    severity=Severity.SHOULD,
    judges=("VCU",),
    tolerances=(_SECONDS, _CURRENT, _SHARE),
    watch=DriveEndsOnAlarm,
)
