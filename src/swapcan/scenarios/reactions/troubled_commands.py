"""How a pack reacts to commands that stay away, stand still or are spoilt."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from swapcan.messages import B2V_ST1, V2B_CMD, BmsState, HvCommand
from swapcan.scenarios.reactions.high_voltage import COMMAND, LEVEL, PACK_STATE, STATE, label
from swapcan.scenarios.reactions.reaction import PACK, Reaction, Track
from typedcan.judge.chunk import LogEnd
from typedcan.judge.findings import Occurrence, Subject
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text
from typedcan.wire.protocol import FieldRef

_COUNTER = FieldRef(V2B_CMD, "aliv")
_PACK_LEVEL = Subject(PACK, B2V_ST1.NAME, B2V_ST1.FIELDS["fault_levl"].dbc_name)

_OPENS = Text(
    "high voltage opens {seconds:.3g} s after {cause}", "{cause}之后 {seconds:.3g} s,高压断开"
)
_KEEPS = Text(
    "high voltage stays closed for the {seconds:.3g} s after {cause}",
    "{cause}之后的 {seconds:.3g} s 内,高压保持闭合",
)
_REPORTS = Text(
    "fault level {level} is reported {seconds:.3g} s after {cause}",
    "{cause}之后 {seconds:.3g} s,上报故障等级 {level}",
)
_SILENCE = Text("the last V2B_CMD", "最后一帧 V2B_CMD ")
_STANDSTILL = Text("the counter of V2B_CMD began to stand still", "V2B_CMD 生命信号停止变化")
_OBEYS = Text(
    'reports "{state}" {seconds:.3g} s after the first of {frames} commands for high voltage on'
    " whose checksum is wrong",
    '共 {frames} 帧校验和错误的上电命令,第一帧之后 {seconds:.3g} s 上报 "{state}"',
)

_SHORTEST = Tolerance(
    name="reaction-silent-vcu.silence",
    value=1.0,
    unit="s",
    text=Text("without V2B_CMD counts as silence", "无 V2B_CMD 超过此时间视为沉默"),
)
_AFTER = Tolerance(
    name="reaction-wrong-checksum.after",
    value=1.0,
    unit="s",
    text=Text(
        "behind the last wrong frame in which the pack may still react to it",
        "最后一帧错误报文之后仍可能产生响应的时间",
    ),
)


class _Troubled(Reaction):
    """Notes what a pack does from a second to another in which commands are not right."""

    wants: ClassVar[tuple[FieldRef, ...]] = (COMMAND, STATE, LEVEL)

    def note(self, start: float, end: float, order: int, cause: Text) -> None:
        """Say whether high voltage opens, and whether the level of faults rises, and when.

        Nothing where it was not closed at the frame ``order``, or nothing came since.
        """
        states = self.track(STATE)
        since = states.after(order).between(start, end)
        if states.at(order) != BmsState.HV_CLOSED or since.empty:
            return
        self.findings.examine(PACK)
        opened = since.where(since.value != BmsState.HV_CLOSED)
        if opened.empty:
            self._add(PACK_STATE, since.where(since.order == since.order[-1]), start, _KEEPS, cause)
        else:
            self._add(PACK_STATE, opened, start, _OPENS, cause)
        levels = self.track(LEVEL)
        raised = levels.after(order).between(start, end)
        raised = raised.where(raised.value > (levels.at(order) or 0))
        if not raised.empty:
            self._add(_PACK_LEVEL, raised, start, _REPORTS, cause)

    def _add(
        self, subject: Subject, reaction: Track, begin: float, text: Text, cause: Text
    ) -> None:
        at = float(reaction.time[0])
        values = {"seconds": at - begin, "cause": cause, "level": int(reaction.value[0])}
        order = int(reaction.order[0])
        self.findings.add(
            Occurrence(
                subject=subject,
                start=at,
                end=at,
                order=order,
                measure=at - begin,
                text=text,
                values=values,
            )
        )


class _Silent(_Troubled):
    """Notes what happens in the longest time without commands."""

    def finish(self, end: LogEnd) -> None:
        """Find that time."""
        commands = self.every(COMMAND)
        if commands.empty:
            return
        until = np.append(commands.time[1:], end.time)
        row = int(np.argmax(until - commands.time))
        start, stop = float(commands.time[row]), float(until[row])
        if stop - start >= self.findings.limit(_SHORTEST):
            self.note(start, stop, int(commands.order[row]), _SILENCE)


class _Stuck(_Troubled):
    """Notes what happens while the counter of the commands stands still the longest."""

    wants = (*_Troubled.wants, _COUNTER)

    def finish(self, end: LogEnd) -> None:  # noqa: ARG002
        """Find that time."""
        counter = self.track(_COUNTER)
        changes = np.flatnonzero(np.diff(counter.value)) + 1
        begins = np.concatenate([np.zeros(1, np.int64), changes])
        ends = np.append(changes, len(counter.value))
        run = int(np.argmax(ends - begins))
        # The first frame of a run is right, the second is the one that stands still.
        row, last = int(begins[run]) + 1, int(ends[run]) - 1
        if row < last:
            start, stop = float(counter.time[row]), float(counter.time[last])
            self.note(start, stop, int(counter.order[row]), _STANDSTILL)


class _WrongChecksum(_Troubled):
    """Sees that high voltage stays open where all commands for it are spoilt."""

    def finish(self, end: LogEnd) -> None:  # noqa: ARG002
        """Judge the states from the first spoilt command on."""
        on = self.every(COMMAND).of(HvCommand.HV_ON)
        wrong = on.where(~on.sound)
        if wrong.empty:
            return
        start, order = float(wrong.time[0]), int(wrong.order[0])
        stop = float(wrong.time[-1]) + self.findings.limit(_AFTER)
        states = self.track(STATE)
        obeyed_right = on.where(on.sound & (on.time <= stop))
        if states.at(order) != BmsState.HV_OPEN or not obeyed_right.empty:
            return
        states = states.after(order).between(start, stop)
        self.findings.examine(PACK, len(states.time))
        obeyed = states.where(states.value != BmsState.HV_OPEN)
        if obeyed.empty:
            return
        at = float(obeyed.time[0])
        values = {
            "state": label(int(obeyed.value[0])),
            "seconds": at - start,
            "frames": len(wrong.time),
        }
        self.findings.add(
            Occurrence(
                subject=PACK_STATE,
                start=at,
                end=float(obeyed.time[-1]),
                order=int(obeyed.order[0]),
                frames=len(obeyed.time),
                text=_OBEYS,
                values=values,
            )
        )


SILENT_VCU = Rule(
    id="reaction-silent-vcu",
    title=Text("What the pack does while the VCU is silent", "VCU 沉默时电池包的响应"),
    purpose=Text(
        "The standard does not say what a pack does when V2B_CMD stays away; a VCU has to know.",
        "标准未规定 V2B_CMD 中断时电池包的行为;VCU 需要了解。",
    ),
    clause="5.2.1",
    severity=Severity.INFO,
    judges=(PACK,),
    tolerances=(_SHORTEST,),
    watch=_Silent,
)

STUCK_COUNTER = Rule(
    id="reaction-stuck-counter",
    title=Text("What the pack does while the counter stands still", "生命信号停止时电池包的响应"),
    purpose=Text(
        "The standard does not say what a pack does when the counter of V2B_CMD stands still.",
        "标准未规定 V2B_CMD 生命信号停止变化时电池包的行为。",
    ),
    clause="Table 14 row 2 (5.2.1)",
    severity=Severity.INFO,
    judges=(PACK,),
    watch=_Stuck,
)

WRONG_CHECKSUM = Rule(
    id="reaction-wrong-checksum",
    title=Text("Spoilt commands are not obeyed", "不执行校验和错误的命令"),
    purpose=Text(
        "The standard gives V2B_CMD a checksum; it serves nothing where a receiver ignores it.",
        "标准为 V2B_CMD 规定了校验和;接收方不检查则无意义。",
    ),
    clause="Table 14 row 1 (5.2.1)",
    severity=Severity.SHOULD,
    judges=(PACK,),
    tolerances=(_AFTER,),
    watch=_WrongChecksum,
)
