"""Frames have the bytes that their message has."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said
from typedcan.judge.measure.channels import Formats, has_length
from typedcan.judge.measure.presence import nodes_of
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.rules.frames.misformed import judge_misformed
from typedcan.logs.frames import FrameBlock
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_LENGTH = Text("{bytes} bytes instead of {right}", "数据长度为 {bytes} 字节,应为 {right} 字节")


class FrameLength(Watcher):
    """Looks at what is left over with an identifier of the protocol."""

    def __init__(self, findings: Findings, protocol: Protocol) -> None:
        super().__init__(findings)
        self._messages = protocol.messages
        self._formats = Formats(protocol)

    def feed(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        block = chunk.block
        wrong_rows: dict[type[Message], NDArray[np.int64]] = {}
        for message, rows in chunk.left_over.of_messages():
            wrong = ~has_length(message, block, rows)
            wrong_rows[message] = rows[wrong & self._formats.fit(message, block, rows)]
        judge_misformed(self.findings, chunk, self._messages, wrong_rows, _describe)


def _describe(message: type[Message], block: FrameBlock, row: int) -> Said:
    return _LENGTH, {"bytes": int(block.length[row]), "right": message.LENGTH}


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    return Rule(
        id="frame-length",
        title=Text("Frames have the bytes of their message", "帧的数据长度与报文一致"),
        purpose=Text(
            "A receiver cannot read signals from bytes that are not there.",
            "缺少字节时,接收方无法读取信号。",
        ),
        severity=Severity.MUST,
        judges=nodes_of(protocol),
        watch=partial(FrameLength, protocol=protocol),
    )
