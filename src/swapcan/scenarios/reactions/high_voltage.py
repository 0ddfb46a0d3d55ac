"""How a pack reacts to the command for high voltage on."""

from __future__ import annotations

from swapcan.messages import (
    B2V_RQ,
    B2V_ST1,
    V2B_CMD,
    BmsState,
    FaultLevel,
    HvCommand,
    HvOffRequest,
)
from swapcan.scenarios.reactions.reaction import PACK, Reaction, Track, first
from typedcan.judge.chunk import LogEnd
from typedcan.judge.findings import Occurrence, Subject
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text
from typedcan.wire.protocol import FieldRef

COMMAND = FieldRef(V2B_CMD, "hv_on_off")
STATE = FieldRef(B2V_ST1, "bms")
LEVEL = FieldRef(B2V_ST1, "fault_levl")
PACK_STATE = Subject(PACK, B2V_ST1.NAME, B2V_ST1.FIELDS["bms"].dbc_name)

_REFUSAL = FieldRef(B2V_RQ, "hv_off")
_LIMIT = Tolerance(
    name="reaction-hv-on.seconds",
    value=10.0,
    unit="s",
    text=Text(
        "from the command to high voltage, or to the report why not; the standard names no time",
        "从上高压指令到高压上电或说明原因的时间;标准未规定该时间",
    ),
)
_STAYS = Text(
    'still "{state}" {seconds:.3g} s after the command, and nothing said why;'
    " {limit:g} s are allowed",
    '发出上高压指令 {seconds:.3g} s 后仍为 "{state}",且未说明原因;允许 {limit:g} s',
)
_REFUSED = Text(
    "high voltage does not come on; {seconds:.3g} s after the command the pack says {reason}",
    "高压未上电;发出上高压指令 {seconds:.3g} s 后电池包上报 {reason}",
)


def label(state: int) -> str:
    """A state of the pack as the standard prints it."""
    return B2V_ST1.FIELDS["bms"].text(BmsState(state))


class _Switching(Reaction):
    """Knows what comes of the first command for high voltage on, in the time that it has."""

    wants = (COMMAND, STATE, LEVEL, _REFUSAL)

    def finish(self, end: LogEnd) -> None:
        """Judge what came of it; nothing where the command or the record ended too early."""
        commands = self.track(COMMAND)
        on = first(commands.of(HvCommand.HV_ON))
        if on is None:
            return
        begin, order = on
        off = first(commands.after(order).of(HvCommand.HV_OFF))
        given = off[0] if off else end.time
        until = begin + self.findings.limit(_LIMIT)
        states = self.track(STATE).after(order).between(begin, min(until, given))
        if states.empty:
            return
        reasons = self._reasons(order, begin, min(until, given))
        closed = not states.of(BmsState.HV_CLOSED).empty
        if closed or reasons or given >= until:
            self.judge(begin, states, [] if closed else reasons)

    def judge(self, begin: float, states: Track, reasons: list[tuple[float, int, str]]) -> None:
        """Judge the states since the command, and why high voltage did not come on.

        Parameters
        ----------
        begin
            The second of the command.
        reasons
            Second, number of the frame and words of each; none where high voltage came on.
        """
        raise NotImplementedError

    def _reasons(self, order: int, begin: float, until: float) -> list[tuple[float, int, str]]:
        found: list[tuple[float, int, str]] = []
        for ref, code in (
            (STATE, BmsState.FAIL_TO_HV_ON),
            (LEVEL, FaultLevel.LEVEL3_MOST_SEVERE_FAULT),
            (_REFUSAL, HvOffRequest.REQUEST_HV_OFF),
        ):
            said = first(self.track(ref).after(order).between(begin, until).of(code))
            if said:
                field = ref.message.FIELDS[ref.field]
                found.append((*said, f'{field.dbc_name} "{field.text(code)}"'))
        return sorted(found)


class _Answered(_Switching):
    """High voltage, or a reason."""

    def judge(self, begin: float, states: Track, reasons: list[tuple[float, int, str]]) -> None:
        """See that there is one of both."""
        self.findings.examine(PACK)
        if reasons or not states.of(BmsState.HV_CLOSED).empty:
            return
        last = float(states.time[-1])
        self.findings.add(
            Occurrence(
                subject=PACK_STATE,
                start=begin,
                end=last,
                order=int(states.order[0]),
                frames=len(states.time),
                measure=last - begin,
                text=_STAYS,
                values={
                    "state": label(int(states.value[-1])),
                    "seconds": last - begin,
                    "limit": self.findings.limit(_LIMIT),
                },
            )
        )


class _Reached(_Switching):
    """High voltage, and no reason against it."""

    def judge(self, begin: float, states: Track, reasons: list[tuple[float, int, str]]) -> None:
        """See that it came on; where nothing is said why not, the other rule is broken."""
        if reasons:
            at, order, reason = reasons[0]
            self.findings.add(
                Occurrence(
                    subject=PACK_STATE,
                    start=at,
                    end=at,
                    order=order,
                    text=_REFUSED,
                    values={"seconds": at - begin, "reason": reason},
                )
            )
        if reasons or not states.of(BmsState.HV_CLOSED).empty:
            self.findings.examine(PACK)


HV_ON = Rule(
    id="reaction-hv-on",
    title=Text("The pack answers the command for high voltage on", "电池包响应上高压指令"),
    purpose=Text(
        "On the command the pack precharges, closes and tells its state, or tells why it cannot.",
        "接收到上电命令后,电池包预充、闭合并反馈当前状态,或说明不能上高压的原因。",
    ),
    clause="5.2.1.1, Table 1 row 9 (5.1.1)",
    severity=Severity.MUST,
    judges=(PACK,),
    tolerances=(_LIMIT,),
    watch=_Answered,
)

HV_REACHED = Rule(
    id="reaction-hv-reached",
    title=Text("High voltage comes on when commanded", "上高压指令后高压上电成功"),
    purpose=Text(
        "To refuse is right where there is a reason; on a sound bench there should be none.",
        "有原因时拒绝上高压是正确的;在正常台架上不应出现。",
    ),
    clause="5.2.1.1",
    severity=Severity.SHOULD,
    judges=(PACK,),
    watch=_Reached,
)
