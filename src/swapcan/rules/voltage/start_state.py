"""A BMU begins with high voltage off."""

from __future__ import annotations

import math

from swapcan.messages import B2V_ST1
from swapcan.rules.voltage.known_silences import HV_ON, Silences
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.measure.presence import Start
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.series import Series
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_QUIET = Tolerance(
    name="start-state.quiet",
    value=1.0,
    unit="s",
    text=Text(
        "without a frame of the BMU, before it counts as started",
        "BMU 在此时间内没有报文,之后的首帧才视为启动",
    ),
)

_ON = Text(
    'its first B2V_ST1 says "{state}", before any command could have been obeyed',
    '首帧 B2V_ST1 的状态为 "{state}",此时尚不可能执行过任何指令',
)


class StartState(Watcher):
    """Looks at the first B2V_ST1 after each start.

    A BMU that was silent while high voltage was on did not start anew.
    """

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._silences = Silences()
        self._started: Start | None = None

    def feed(self, chunk: Chunk) -> None:
        """Judge the starts whose first status is here."""
        under_voltage = {
            found.silence for found in self._silences.feed(chunk) if found.known.high_voltage_on
        }
        status = chunk.sound(B2V_ST1)
        for start in chunk.timing.starts:
            if start.node == B2V_ST1.SENDER:
                self._judge(status, start.order)
                real = self._is_quiet(start) and start.after not in under_voltage
                self._started = start if real else None
        self._judge(status, math.inf)

    def _is_quiet(self, start: Start) -> bool:
        before = start.after.start if start.after else 0.0
        return start.time - before >= self.findings.limit(_QUIET)

    def _judge(self, status: Series, until: float) -> None:
        """Judge the first status since the start, if it comes before a frame of the log."""
        if self._started is None:
            return
        row = int(status.order.searchsorted(self._started.order))
        if row == len(status) or status.order[row] >= until:
            return
        self._started = None
        self.findings.examine(B2V_ST1.SENDER)
        state = int(status.raw("bms")[row])
        if state in HV_ON:
            self.findings.add(
                Occurrence(
                    subject=Subject(B2V_ST1.SENDER, B2V_ST1.NAME, "B2V_ST1_BMS"),
                    start=float(status.time[row]),
                    end=float(status.time[row]),
                    order=int(status.order[row]),
                    text=_ON,
                    values={"state": B2V_ST1.FIELDS["bms"].labels[state]},
                )
            )


RULE = Rule(
    id="start-state",
    title=Text("A BMU begins with high voltage off", "BMU 启动时高压断开"),
    purpose=Text(
        "High voltage comes with the command of the VCU, by way of the precharge.",
        "高压只能由 VCU 上电指令经预充后接通。",
    ),
    clause="5.2.1.1, Table 1 row 9",
    severity=Severity.SHOULD,
    judges=(B2V_ST1.SENDER,),
    tolerances=(_QUIET,),
    watch=StartState,
)
