"""Frames have the bytes that their message has."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.chunk import Chunk
from swapcan.conform.findings import Said
from swapcan.conform.rule import Rule, Severity, Watcher
from swapcan.conform.rules.frames.left_over import left_over
from swapcan.conform.rules.frames.odd import judge_odd
from swapcan.conform.text import Text
from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.wire.message import Message

_OTHER_KINDS = np.uint8(FrameFlag.REMOTE | FrameFlag.FD)

_LENGTH = Text("{bytes} bytes instead of {right}", "数据长度为 {bytes} 字节,应为 {right} 字节")


class FrameLength(Watcher):
    """Looks at what is left over with an identifier of the protocol."""

    def take(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        block = chunk.block
        odd: dict[type[Message], NDArray[np.int64]] = {}
        for message, rows in left_over(chunk).by_message():
            wrong = block.length[rows] != message.LENGTH
            odd[message] = rows[wrong & ((block.flags[rows] & _OTHER_KINDS) == 0)]
        judge_odd(self.findings, chunk, odd, _describe)


def _describe(message: type[Message], block: FrameBlock, row: int) -> Said:
    return _LENGTH, {"bytes": int(block.length[row]), "right": message.LENGTH}


RULE = Rule(
    id="frame-length",
    title=Text("Frames have 8 bytes", "帧的数据长度为 8 字节"),
    purpose=Text(
        "A receiver cannot read signals from bytes that are not there.",
        "缺少字节时,接收方无法读取信号。",
    ),
    clause="A.1",
    severity=Severity.MUST,
    judges=PROTOCOL.nodes,
    watch=FrameLength,
)
