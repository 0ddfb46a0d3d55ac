"""Checksums are those that the bytes of their frame make."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.series import Series
from typedcan.model.seal import Seal
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_WRONG = Text(
    "checksum 0x{given:02X}, the bytes make 0x{right:02X}",
    "校验和为 0x{given:02X},按字节计算应为 0x{right:02X}",
)


class Checksum(Watcher):
    """Compares each checksum with the one that the bytes make."""

    def __init__(self, findings: Findings, messages: Sequence[type[Message]]) -> None:
        super().__init__(findings)
        self._messages = messages

    def feed(self, chunk: Chunk) -> None:
        """Judge all frames of messages that have a checksum, where something computes it."""
        for message in self._messages:
            seal = chunk.seals.get(message.NAME)
            if seal is None:
                continue
            series, sound = chunk.frames(message), chunk.sound(message)
            wrong = np.zeros(len(series), np.bool_)
            if series.fresh != sound.fresh:
                wrong = ~np.isin(series.order, sound.order)
            subject = Subject(message.SENDER, message.NAME)
            self.findings.rows(subject, series, wrong, partial(_describe, seal, series))


def _describe(seal: Seal, series: Series, row: int) -> Said:
    data = bytes(series.payload[row])[: series.message.LENGTH]
    return _WRONG, {"given": seal.read(data), "right": seal.expected(data)}


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    protected = tuple(each for each in protocol.messages if each.CHECKSUM)
    return Rule(
        id="checksum",
        title=Text("Checksums are right", "校验和正确"),
        purpose=Text(
            "A receiver drops a frame whose checksum is wrong.",
            "接收方会丢弃校验和错误的报文。",
        ),
        severity=Severity.MUST,
        judges=tuple(dict.fromkeys(message.SENDER for message in protected)),
        watch=partial(Checksum, messages=protected),
    )
