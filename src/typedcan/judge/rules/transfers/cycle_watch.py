"""Readings by group come in cycles: whole, and in the order of their numbers."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Subject
from typedcan.judge.measure.steps import frame_of_cycle, key_of, keyed
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.rules.transfers.turn_order import CycleLearner, Learner, Rows
from typedcan.judge.rules.transfers.turn_watch import TurnWatcher
from typedcan.judge.rules.transfers.turns import Kind
from typedcan.judge.scope import Scope
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol, Transfer

MISSING_OR_DOUBLED: Mapping[Kind, Text] = {
    Kind.MISSING: Text(
        "missing in a cycle of {size} frames",
        "在 {size} 帧的周期中缺失",
    ),
    Kind.DOUBLED: Text(
        "came twice in a cycle of {size} frames",
        "在 {size} 帧的周期中出现两次",
    ),
}
"""What is to be complete."""

OUT_OF_ORDER: Mapping[Kind, Text] = {
    Kind.LATE: Text(
        "came after a frame that follows it in a cycle of {size} frames",
        "在 {size} 帧的周期中晚于其后的帧",
    ),
    Kind.UNSORTED: Text(
        "comes after a higher number in each cycle of {size} frames",
        "在每个 {size} 帧的周期中排在较大编号之后",
    ),
}
"""What is to be in order."""


def _pause_of(rule: str) -> Tolerance:
    """How long a pause cuts a cycle off, for a rule."""
    return Tolerance(
        name=f"{rule}.periods",
        value=5.0,
        text=Text(
            "Periods without a frame after which what comes is a new beginning",
            "超过该周期数没有报文时,其后的报文视为重新开始",
        ),
    )


class CycleWatcher(TurnWatcher):
    """Follows the frames of all groups.

    Parameters
    ----------
    message, fields
        What they are, and its fields of the group and of the frame number.
    pause
        How many periods without a frame cut a cycle off.
    texts
        What to say of which faults.
    """

    def __init__(
        self,
        findings: Findings,
        *,
        message: type[Message],
        fields: tuple[str, str],
        pause: Tolerance,
        texts: Mapping[Kind, Text],
    ) -> None:
        self._message = message
        self._fields = fields
        seconds = findings.limit(pause) * (message.PERIOD or 0.0)
        super().__init__(findings, node=message.SENDER, pause=seconds, texts=texts)

    def _new_learner(self) -> Learner:
        return CycleLearner()

    def _new_rows(self, chunk: Chunk) -> Rows:
        series = chunk.frames(self._message)
        return Rows(
            key_of(series, self._fields), series.time[series.first :], series.order[series.first :]
        )

    def _subject(self, key: int) -> Subject:
        message = self._message
        return Subject(message.SENDER, message.NAME, detail=frame_of_cycle(key))


def rules(protocol: Protocol, scope: Scope) -> tuple[Rule, ...]:
    """Two of each transfer whose frames are numbered within groups, in the protocol's order."""
    fields = keyed(protocol)
    return tuple(
        rule
        for transfer in protocol.transfers
        if transfer.messages[0] in fields
        for rule in _rules(transfer, scope, fields[transfer.messages[0]])
    )


def _rules(transfer: Transfer, scope: Scope, fields: tuple[str, str]) -> tuple[Rule, Rule]:
    name = scope.transfers.get(transfer.name, transfer.name.replace("_", "-"))
    message = transfer.messages[0]
    watch = partial(CycleWatcher, message=message, fields=fields)
    whole, order = _pause_of(f"{name}-complete"), _pause_of(f"{name}-order")
    return (
        Rule(
            id=f"{name}-complete",
            title=Text(f"Each cycle is whole: {transfer.title}", f"每个周期完整:{transfer.title}"),
            purpose=Text(
                "A missing frame leaves old values at the receiver.",
                "缺帧时接收方只能使用旧值。",
            ),
            severity=Severity.MUST,
            judges=(message.SENDER,),
            tolerances=(whole,),
            watch=partial(watch, pause=whole, texts=MISSING_OR_DOUBLED),
        ),
        Rule(
            id=f"{name}-order",
            title=Text(
                f"Frames come in the order of their numbers: {transfer.title}",
                f"按编号顺序发送:{transfer.title}",
            ),
            purpose=Text(
                "A receiver that takes a lower number for the beginning of a cycle would mix two "
                "cycles.",
                "接收方如以编号变小作为新周期的起点,会混淆两个周期的数据。",
            ),
            severity=Severity.SHOULD,
            judges=(message.SENDER,),
            tolerances=(order,),
            watch=partial(watch, pause=order, texts=OUT_OF_ORDER),
        ),
    )
