"""High voltage goes off on command."""

from __future__ import annotations

from swapcan.messages import B2V_ST0, B2V_ST1, BmsState, ChargeState, HvCommand, RelayState
from swapcan.rules.voltage.command import Commands
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.measure.last_known import LastKnown
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_SECONDS = Tolerance(
    name="hv-off-in-time.seconds",
    value=5.0,
    unit="s",
    text=Text(
        "from the command HV Off to the open circuit; the standard names no time, and the "
        "current may have to go first",
        "从下高压指令到主回路断开的时间;标准未规定,可能需先卸载电流",
    ),
)

_STATE = Subject("BMU", "B2V_ST1", "B2V_ST1_BMS")
_RELAY = Subject("BMU", "B2V_ST0", "B2V_ST0_ST_MainPos")

_CLOSED = Text(
    "still HV closed after {seconds:.2f} s of the command HV Off",
    "下高压指令已持续 {seconds:.2f} s,状态仍为 HV closed",
)
_WELDED = Text(
    "main positive relay still closed after {seconds:.2f} s of the command HV Off",
    "下高压指令已持续 {seconds:.2f} s,主正继电器仍闭合",
)


class HvOffInTime(LastingWatcher):
    """Measures how long state and main positive relay stay on under the command off."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        seconds = findings.limit(_SECONDS)
        self._closed = self.lasting(_STATE, seconds, B2V_ST1)
        self._welded = self.lasting(_RELAY, seconds, B2V_ST1)
        self._commands = Commands()

    def feed(self, chunk: Chunk) -> None:
        """Judge what is on under the command off; a pack that charges may have to be."""
        states = chunk.sound(B2V_ST1)
        known, command = self._commands.at(chunk, states)
        judged = known & (command == HvCommand.HV_OFF)
        judged &= states.raw("chg_st") != ChargeState.CHARGING
        relays = LastKnown(chunk.sound(B2V_ST0), states)
        self._closed.feed(states, judged, states.raw("bms") == BmsState.HV_CLOSED, _describe_state)
        self._welded.feed(
            states,
            judged & relays.known,
            relays.is_code("st_main_pos", RelayState.CLOSED),
            _describe_relay,
        )


def _describe_state(_: int) -> Said:
    return _CLOSED, {}


def _describe_relay(_: int) -> Said:
    return _WELDED, {}


RULE = Rule(
    id="hv-off-in-time",
    title=Text("High voltage goes off on command", "收到下高压指令后及时下电"),
    purpose=Text(
        "The BMS enters the state off when it receives the command: who works on the truck "
        "relies on it.",
        "电池管理系统接收到下电命令后进入下电状态,维修人员的安全依赖于此。",
    ),
    clause="5.2.1.4",
    severity=Severity.SHOULD,
    judges=("BMU",),
    tolerances=(_SECONDS,),
    watch=HvOffInTime,
)
