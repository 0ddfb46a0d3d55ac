"""Checksums are those that the bytes of their frame make."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np

from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.rules.one_of import Making, OneOf, Together, readings_of
from typedcan.judge.series import Series
from typedcan.model import protocol as model
from typedcan.model.checksums.registry import AlgorithmError
from typedcan.model.seal import Seal, seal_of
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_WRONG = Text(
    "checksum 0x{given:02X}, the bytes make 0x{right:02X}",
    "校验和为 0x{given:02X},按字节计算应为 0x{right:02X}",
)


class Checksum(Watcher):
    """Compares each checksum with the one that the bytes make."""

    def __init__(
        self,
        findings: Findings,
        messages: Sequence[type[Message]],
        read: Mapping[str, Seal] | None = None,
    ) -> None:
        super().__init__(findings)
        self._messages = messages
        self._read = read or {}

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
            if other := self._read.get(message.NAME):
                seal = other
                length = message.LENGTH
                right = [seal.verify(bytes(row)[:length]) for row in series.payload[wrong]]
                wrong[wrong] = ~np.array(right, np.bool_)
            subject = Subject(message.SENDER, message.NAME)
            self.findings.rows(subject, series, wrong, partial(_describe, seal, series))


def _describe(seal: Seal, series: Series, row: int) -> Said:
    data = bytes(series.payload[row])[: series.message.LENGTH]
    return _WRONG, {"given": seal.read(data), "right": seal.expected(data)}


def _watch(
    findings: Findings,
    messages: Sequence[type[Message]],
    read: Mapping[str, Sequence[Seal]],
) -> Watcher:
    """By each of the readings of a checksum, where there are several."""
    several: list[Watcher] = []
    for message in messages:
        if message.NAME in read:
            make: list[Making] = [partial(Checksum, messages=[message])]
            make += [
                partial(Checksum, messages=[message], read={message.NAME: seal})
                for seal in read[message.NAME]
            ]
            several.append(OneOf(findings, make))
    plain = [message for message in messages if message.NAME not in read]
    return Together(findings, [Checksum(findings, plain), *several])


def _read_otherwise(protocol: model.Protocol) -> dict[str, list[Seal]]:
    """By names of messages, what makes their checksums in the other readings of the spec."""
    found: dict[str, list[Seal]] = {}
    for message in readings_of(protocol, "checksum"):
        try:
            seal = seal_of(message, {})
        except AlgorithmError:
            continue
        if seal:
            found.setdefault(message.name, []).append(seal)
    return found


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
        watch=partial(_watch, messages=protected, read=_read_otherwise(protocol.model)),
    )
