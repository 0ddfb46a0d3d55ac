"""The pack begins to switch on soon after it is told to."""

from __future__ import annotations

import math

import numpy as np

from swapcan.messages import (
    B2V_RQ,
    B2V_ST1,
    V2B_CMD,
    BmsState,
    FaultLevel,
    HvCommand,
    HvOffRequest,
)
from swapcan.rules.voltage.command import moving
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.measure.last_known import LastKnown, fresh_for
from typedcan.judge.measure.since import Since
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_SECONDS = Tolerance(
    name="hv-on-in-time.seconds",
    value=2.0,
    unit="s",
    text=Text(
        "from the command HV On to the state Precharge; the standard names no time",
        "从上高压指令到进入预充状态的时间;标准未规定该时间",
    ),
)

_SUBJECT = Subject("BMU", "B2V_ST1", "B2V_ST1_BMS")

_STAYS = Text(
    "still HV open for {seconds:.2f} s under the command HV On, and nothing says why",
    "上高压指令下仍为 HV open,持续 {seconds:.2f} s,且未说明原因",
)


class HvOnInTime(LastingWatcher):
    """Watches the state from a command on that was seen to come."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._stays = self.lasting(_SUBJECT, findings.limit(_SECONDS), B2V_ST1)
        self._on = Since(fresh_for(V2B_CMD, findings), seen=True)
        self._open = Since(math.inf)

    def feed(self, chunk: Chunk) -> None:
        """Judge the states under the command on."""
        states, commands = chunk.sound(B2V_ST1), chunk.sound(V2B_CMD)
        is_on = (commands.raw("hv_on_off") == HvCommand.HV_ON) & moving(commands)
        told = self._on.feed(commands, is_on)
        is_open = states.raw("bms") == BmsState.HV_OPEN
        opened = self._open.feed(states, is_open)
        if not len(commands):
            return
        command, request = LastKnown(commands, states), LastKnown(chunk.sound(B2V_RQ), states)
        since = told[command.rows]
        judged = command.known & ~np.isnan(since)
        judged &= states.raw("fault_levl") < FaultLevel.LEVEL3_MOST_SEVERE_FAULT
        judged &= ~request.is_code("hv_off", HvOffRequest.REQUEST_HV_OFF)
        # A pack that opens on its own while it is told to be on breaks other rules, if any.
        self._stays.feed(states, judged, opened <= since, _describe)


def _describe(_: int) -> Said:
    return _STAYS, {}


RULE = Rule(
    id="hv-on-in-time",
    title=Text("The command on begins a precharge", "上高压指令后及时进入预充"),
    purpose=Text(
        "After the command the BMS enters precharge; one that cannot says so, by a fault of "
        "level 3, the request for high voltage off, or the state Fail to HV on.",
        "接收到上电命令后电池管理系统进入预充阶段;不能上高压时应以三级故障、下高压请求或 "
        "Fail to HV on 状态说明。",
    ),
    clause="5.2.1.1",
    severity=Severity.SHOULD,
    judges=("BMU",),
    tolerances=(_SECONDS,),
    watch=HvOnInTime,
)
