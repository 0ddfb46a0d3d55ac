"""Bits that no signal and no reserved field has are 0."""

from __future__ import annotations

from functools import cache

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.chunk import Chunk
from swapcan.conform.findings import Findings
from swapcan.conform.rule import Rule, Severity, Watcher
from swapcan.conform.rules.frames.bits import ALL_BITS, judge_zeros
from swapcan.conform.rules.frames.reserved_bits import MASKS
from swapcan.conform.text import Text
from typedcan.model.layout import bits
from typedcan.wire.message import Message

_SET = Text("bits that no signal has are 1: {bits}", "未分配给信号的位为 1:第 {bits} 位")


class UnassignedBits(Watcher):
    """Looks at what is between signals and behind them."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._masks = _unassigned()

    def take(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        judge_zeros(self.findings, chunk, self._masks, _SET)


@cache
def _unassigned() -> dict[type[Message], int]:
    masks: dict[type[Message], int] = {}
    for message in PROTOCOL.messages:
        free = ALL_BITS & ~MASKS.get(message, 0)
        for signal in message.MODEL.signals:
            free &= ~sum(1 << bit for bit in bits(signal))
        if free:
            masks[message] = free
    return masks


RULE = Rule(
    id="unassigned-bits",
    title=Text("Bits without a signal are 0", "未分配的位填充 0"),
    purpose=Text(
        "The standard says nothing of them; 0 is what it fills with elsewhere, and what a later "
        "edition will count on.",
        "标准未规定这些位;其他处均填充 0,后续版本也会以此为前提。",
    ),
    clause="A.1",
    severity=Severity.INFO,
    judges=PROTOCOL.nodes,
    watch=UnassignedBits,
)
