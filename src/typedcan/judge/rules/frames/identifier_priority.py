"""Identifiers have the priority that is printed."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said
from typedcan.judge.measure.presence import nodes_of
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.rules.frames.identifiers import PRIORITY_SHIFT, Identifiers
from typedcan.judge.rules.frames.misformed import judge_misformed
from typedcan.logs.frames import FrameBlock
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_REST = (1 << PRIORITY_SHIFT) - 1

_PRIORITY = Text(
    "identifier 0x{found:08X} has priority {priority}, the standard has 0x{right:08X} with {due}",
    "标识符 0x{found:08X} 的优先级为 {priority},标准规定为 0x{right:08X},优先级 {due}",
)


class IdentifierPriority(Watcher):
    """Looks for identifiers that differ from a message's in the highest three bits only."""

    def __init__(self, findings: Findings, protocol: Protocol) -> None:
        super().__init__(findings)
        self._messages = protocol.messages
        self._identifiers = Identifiers(protocol)
        self._by_rest = {message.FRAME_ID & _REST: message for message in protocol.messages}

    def feed(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        left = chunk.left_over
        wrong_rows: dict[type[Message], NDArray[np.int64]] = {}
        for key, rows in left.of(np.flatnonzero(self._identifiers.has_other_priority(left.keys))):
            message = self._by_rest[key & _REST]
            wrong_rows[message] = (
                np.concatenate([wrong_rows[message], rows]) if message in wrong_rows else rows
            )
        judge_misformed(self.findings, chunk, self._messages, wrong_rows, _describe)


def _describe(message: type[Message], block: FrameBlock, row: int) -> Said:
    found = int(block.frame_id[row])
    return _PRIORITY, {
        "found": found,
        "priority": found >> PRIORITY_SHIFT,
        "right": message.FRAME_ID,
        "due": message.FRAME_ID >> PRIORITY_SHIFT,
    }


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    return Rule(
        id="identifier-priority",
        title=Text("Identifiers have the printed priority", "标识符的优先级与标准一致"),
        purpose=Text(
            "Receivers compare whole identifiers: with another priority the message is not seen, "
            "and it gets its turn on the bus sooner or later than planned.",
            "接收方按完整标识符过滤:优先级不同则收不到该报文,其总线仲裁次序也与设计不符。",
        ),
        severity=Severity.MUST,
        judges=nodes_of(protocol),
        watch=partial(IdentifierPriority, protocol=protocol),
    )
