"""Reserved bits are 0."""

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

_SET = Text("reserved bits are 1: {bits}", "预留位为 1:第 {bits} 位")


def reserved_masks(protocol: Protocol) -> dict[type[Message], int]:
    """The reserved bits of the messages that have such and send them as 0."""
    found = {
        message: mask_of(field for field in message.MODEL.reserved if not field.value)
        for message in protocol.messages
    }
    return {message: mask for message, mask in found.items() if mask}


class ReservedBits(Watcher):
    """Looks at the reserved bits of messages that have such."""

    def __init__(self, findings: Findings, protocol: Protocol) -> None:
        super().__init__(findings)
        self._masks = reserved_masks(protocol)

    def feed(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        judge_zeros(self.findings, chunk, self._masks, _SET)


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    senders = {message.SENDER for message in reserved_masks(protocol)}
    return Rule(
        id="reserved-bits",
        title=Text("Reserved bits are 0", "预留位填充 0"),
        purpose=Text(
            "A later edition may give them a meaning, which is then taken from what is sent today.",
            "后续版本可能定义预留位的含义,届时会按现在发送的内容解释。",
        ),
        severity=Severity.MUST,
        judges=tuple(node for node in nodes_of(protocol) if node in senders),
        watch=partial(ReservedBits, protocol=protocol),
    )
