"""Identifiers of the protocol come as classical data frames."""

from __future__ import annotations

from functools import partial

import numpy as np

from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.rules.frames.odd import judge_odd
from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_ODD = np.uint8(FrameFlag.REMOTE | FrameFlag.FD)

_REMOTE = Text(
    "a remote frame; it has to be a classical data frame", "为远程帧,应为经典 CAN 数据帧"
)
_FD = Text(
    "a CAN FD frame; it has to be a classical data frame", "为 CAN FD 帧,应为经典 CAN 数据帧"
)


class FrameKind(Watcher):
    """Looks at what is left over with an identifier of the protocol."""

    def __init__(self, findings: Findings, protocol: Protocol) -> None:
        super().__init__(findings)
        self._messages = protocol.messages

    def take(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        flags = chunk.block.flags
        odd = {
            message: rows[(flags[rows] & _ODD) != 0]
            for message, rows in chunk.left_over.of_messages()
        }
        judge_odd(self.findings, chunk, self._messages, odd, _describe)


def _describe(message: type[Message], block: FrameBlock, row: int) -> Said:  # noqa: ARG001
    return (_REMOTE if block.flags[row] & FrameFlag.REMOTE else _FD), {}


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    return Rule(
        id="frame-kind",
        title=Text("Frames are classical data frames", "帧为经典 CAN 数据帧"),
        purpose=Text(
            "A remote frame carries no data, and a node without CAN FD destroys FD frames on the "
            "bus.",
            "远程帧不携带数据;不支持 CAN FD 的节点会破坏总线上的 FD 帧。",
        ),
        severity=Severity.MUST,
        judges=protocol.nodes,
        watch=partial(FrameKind, protocol=protocol),
    )
