"""Identifiers have the priority that is printed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.chunk import Chunk
from swapcan.conform.findings import Said
from swapcan.conform.rule import Rule, Severity, Watcher
from swapcan.conform.rules.frames.identifiers import PRIORITY_SHIFT, has_other_priority
from swapcan.conform.rules.frames.left_over import left_over
from swapcan.conform.rules.frames.odd import judge_odd
from swapcan.conform.text import Text
from typedcan.logs.frames import FrameBlock
from typedcan.wire.message import Message

_REST = (1 << PRIORITY_SHIFT) - 1
_BY_REST = {message.FRAME_ID & _REST: message for message in PROTOCOL.messages}

_PRIORITY = Text(
    "identifier 0x{found:08X} has priority {priority}, the standard has 0x{right:08X} with {due}",
    "标识符 0x{found:08X} 的优先级为 {priority},标准规定为 0x{right:08X},优先级 {due}",
)


class IdentifierPriority(Watcher):
    """Looks for identifiers that differ from a message's in the highest three bits only."""

    def take(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        left = left_over(chunk)
        odd: dict[type[Message], NDArray[np.int64]] = {}
        for key, rows in left.of(np.flatnonzero(has_other_priority(left.keys))):
            message = _BY_REST[key & _REST]
            odd[message] = np.concatenate([odd[message], rows]) if message in odd else rows
        judge_odd(self.findings, chunk, odd, _describe)


def _describe(message: type[Message], block: FrameBlock, row: int) -> Said:
    found = int(block.frame_id[row])
    return _PRIORITY, {
        "found": found,
        "priority": found >> PRIORITY_SHIFT,
        "right": message.FRAME_ID,
        "due": message.FRAME_ID >> PRIORITY_SHIFT,
    }


RULE = Rule(
    id="identifier-priority",
    title=Text("Identifiers have the printed priority", "标识符的优先级与标准一致"),
    purpose=Text(
        "Receivers compare whole identifiers: with another priority the message is not seen, and "
        "it gets its turn on the bus sooner or later than planned.",
        "接收方按完整标识符过滤:优先级不同则收不到该报文,其总线仲裁次序也与设计不符。",
    ),
    clause="A.1 (4.2.1)",
    severity=Severity.MUST,
    judges=PROTOCOL.nodes,
    watch=IdentifierPriority,
)
