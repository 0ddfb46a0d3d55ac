"""Reserved bits are 0."""

from __future__ import annotations

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.chunk import Chunk
from swapcan.conform.rule import Rule, Severity, Watcher
from swapcan.conform.rules.frames.bits import judge_zeros
from swapcan.conform.text import Text
from typedcan.model.layout import bits
from typedcan.wire.message import Message

RESERVED: dict[type[Message], tuple[tuple[int, int], ...]] = {
    message: tuple((min(bits(each)), max(bits(each))) for each in message.MODEL.reserved)
    for message in PROTOCOL.messages
    if message.MODEL.reserved
}
"""First and last bit of each field that A.1 prints as Reserved, bit 0 the lowest of byte 0."""

MASKS = {
    message: sum((1 << last + 1) - (1 << first) for first, last in fields)
    for message, fields in RESERVED.items()
}
"""The same as numbers with those bits set."""

_SET = Text("reserved bits are 1: {bits}", "预留位为 1:第 {bits} 位")


class ReservedBits(Watcher):
    """Looks at the reserved bits of messages that have such."""

    def take(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        judge_zeros(self.findings, chunk, MASKS, _SET)


RULE = Rule(
    id="reserved-bits",
    title=Text("Reserved bits are 0", "预留位填充 0"),
    purpose=Text(
        "A later edition may give them a meaning, which is then taken from what is sent today. "
        "Filled with 0 is printed in tables 3 and 14, and holds for the other reserved fields.",
        "后续版本可能定义预留位的含义,届时会按现在发送的内容解释。表 3 和表 14 规定预留填充 0,"
        "其他预留字段同样适用。",
    ),
    clause="A.1; Table 3 rows 3 and 4 (5.1.3), Table 14 row 21 (5.2.1)",
    severity=Severity.MUST,
    judges=tuple(node for node in PROTOCOL.nodes if node in {each.SENDER for each in RESERVED}),
    watch=ReservedBits,
)
