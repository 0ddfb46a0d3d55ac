"""Frames have the format of their message: classic CAN or CAN FD, and data."""

from __future__ import annotations

from functools import partial

from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said
from typedcan.judge.measure.channels import Formats
from typedcan.judge.measure.presence import nodes_of
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.rules.frames.misformed import judge_misformed
from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_REMOTE = Text(
    "a remote frame; it has to be a classical data frame", "为远程帧,应为经典 CAN 数据帧"
)
_FD = Text(
    "a CAN FD frame; it has to be a classical data frame", "为 CAN FD 帧,应为经典 CAN 数据帧"
)

_REMOTE_FOR_FD = Text("a remote frame; it has to be a CAN FD frame", "为远程帧,应为 CAN FD 帧")
_CLASSIC = Text("a classical frame; it has to be a CAN FD frame", "为经典 CAN 帧,应为 CAN FD 帧")


class FrameKind(Watcher):
    """Looks at what is left over with an identifier of the protocol."""

    def __init__(self, findings: Findings, protocol: Protocol) -> None:
        super().__init__(findings)
        self._messages = protocol.messages
        self._formats = Formats(protocol)

    def feed(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        wrong_rows = {
            message: rows[~self._formats.fit(message, chunk.block, rows)]
            for message, rows in chunk.left_over.of_messages()
        }
        judge_misformed(self.findings, chunk, self._messages, wrong_rows, _describe)


def _describe(message: type[Message], block: FrameBlock, row: int) -> Said:
    if block.flags[row] & FrameFlag.REMOTE:
        return (_REMOTE_FOR_FD if message.MODEL.is_fd else _REMOTE), {}
    return (_CLASSIC if message.MODEL.is_fd else _FD), {}


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    return Rule(
        id="frame-kind",
        title=Text("Frames have the format of their message", "帧格式与报文一致"),
        purpose=Text(
            "A remote frame carries no data, and a node without CAN FD destroys FD frames on the "
            "bus.",
            "远程帧不携带数据;不支持 CAN FD 的节点会破坏总线上的 FD 帧。",
        ),
        severity=Severity.MUST,
        judges=nodes_of(protocol),
        watch=partial(FrameKind, protocol=protocol),
    )
