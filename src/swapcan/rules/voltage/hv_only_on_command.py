"""Precharge begins only where the VCU commands high voltage on."""

from __future__ import annotations

import math

import numpy as np

from swapcan.messages import B2V_ST1, V2B_CMD, BmsState, ChargeLine, HvCommand
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.measure.last_known import LastKnown, fresh_for
from typedcan.judge.measure.since import Since, last
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_BEFORE = Tolerance(
    name="hv-only-on-command.before",
    value=1.0,
    unit="s",
    text=Text(
        "how long before the precharge the command may have been HV On for the last time",
        "预充开始前最后一次上高压指令最多可提前的时间",
    ),
)

_SUBJECT = Subject("BMU", "B2V_ST1", "B2V_ST1_BMS")

_UNASKED = Text(
    "precharge begins, but for {seconds:.2f} s before it no V2B_CMD said HV On",
    "预充开始,但此前 {seconds:.2f} s 内没有 V2B_CMD 发出上高压指令",
)


class HvOnlyOnCommand(Watcher):
    """Looks back from each begin of a precharge."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._before = findings.limit(_BEFORE)
        self._heard = Since(fresh_for(V2B_CMD, findings))
        self._on = -math.inf

    def feed(self, chunk: Chunk) -> None:
        """Judge the begins of precharge."""
        states, commands = chunk.sound(B2V_ST1), chunk.sound(V2B_CMD)
        heard = self._heard.feed(commands, np.ones(len(commands), np.bool_))
        is_on = commands.raw("hv_on_off") == HvCommand.HV_ON
        on = last(commands, is_on, commands.time, self._on)
        # A gun asks for high voltage as well: what a pack does then is not printed.
        precharge = states.raw("bms") == BmsState.PRECHARGE
        plugged = states.raw("chg_line") == ChargeLine.CONNECTED
        begins = np.flatnonzero(precharge[1:] & ~precharge[:-1]) + 1
        if len(begins) and len(commands):
            beside = LastKnown(commands, states)
            for row in begins[(beside.known & ~plugged)[begins]].tolist():
                at = int(beside.rows[row])
                # It may have begun at any time since the state before.
                earliest = float(states.time[row - 1]) - self._before
                if heard[at] <= earliest:
                    seconds = float(states.time[row]) - max(float(on[at]), float(heard[at]))
                    asked = float(on[at]) >= earliest
                    self._judge(
                        float(states.time[row]), int(states.order[row]), seconds, asked=asked
                    )
        if len(commands):
            self._on = float(on[-1])

    def _judge(self, time: float, order: int, seconds: float, *, asked: bool) -> None:
        self.findings.examine("BMU")
        if not asked:
            self.findings.add(
                Occurrence(
                    subject=_SUBJECT,
                    start=time,
                    end=time,
                    order=order,
                    measure=seconds,
                    text=_UNASKED,
                    values={"seconds": seconds},
                )
            )


RULE = Rule(
    id="hv-only-on-command",
    title=Text("Precharge begins only on command", "仅在收到上高压指令后进入预充"),
    purpose=Text(
        "The BMS enters precharge when it receives the command for high voltage on: nobody "
        "expects voltage on the bus bar before.",
        "电池管理系统接收到上电命令后才进入预充阶段;在此之前任何一方都不会预期母线上有高压。",
    ),
    clause="5.2.1.1",
    severity=Severity.MUST,
    judges=("BMU",),
    tolerances=(_BEFORE,),
    watch=HvOnlyOnCommand,
)
