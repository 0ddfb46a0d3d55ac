"""Bits that no signal and no reserved field has are 0."""

from __future__ import annotations

from functools import partial

from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings
from typedcan.judge.measure.presence import nodes_of
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.rules.frames.bits import judge_zeros, mask_of
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_SET = Text("bits that no signal has are 1: {bits}", "未分配给信号的位为 1:第 {bits} 位")


class UnassignedBits(Watcher):
    """Looks at what is between signals and behind them."""

    def __init__(self, findings: Findings, protocol: Protocol) -> None:
        super().__init__(findings)
        free = {message: _unassigned(message) for message in protocol.messages}
        self._masks = {message: mask for message, mask in free.items() if mask}

    def feed(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        judge_zeros(self.findings, chunk, self._masks, _SET)


def _unassigned(message: type[Message]) -> int:
    every = (1 << 8 * message.LENGTH) - 1
    return every & ~mask_of((*message.MODEL.signals, *message.MODEL.reserved))


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    return Rule(
        id="unassigned-bits",
        title=Text("Bits without a signal are 0", "未分配的位填充 0"),
        purpose=Text(
            "Nothing is said of them; 0 is what is filled with elsewhere, and what a later edition "
            "will count on.",
            "协议未规定这些位;其他处均填充 0,后续版本也会以此为前提。",
        ),
        severity=Severity.INFO,
        judges=nodes_of(protocol),
        watch=partial(UnassignedBits, protocol=protocol),
    )
