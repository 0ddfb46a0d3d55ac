"""Checksums are those that the bytes of their frame make."""

from __future__ import annotations

from functools import partial

import numpy as np

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.chunk import Chunk
from swapcan.conform.findings import Said, Subject
from swapcan.conform.rule import Rule, Severity, Watcher
from swapcan.conform.series import Series
from swapcan.conform.text import Text
from typedcan.logs.checks import has_checksum
from typedcan.wire.protect import STANDARD_ALGORITHMS, expected_checksum

_PROTECTED = tuple(message for message in PROTOCOL.messages if has_checksum(message.MODEL))

_WRONG = Text(
    "checksum 0x{given:02X}, the bytes make 0x{right:02X}",
    "校验和为 0x{given:02X},按字节计算应为 0x{right:02X}",
)


class Checksum(Watcher):
    """Compares each checksum with the XOR of the other bytes."""

    def take(self, chunk: Chunk) -> None:
        """Judge all frames of messages that have a checksum."""
        for message in _PROTECTED:
            series, sound = chunk.frames(message), chunk.sound(message)
            wrong = np.zeros(len(series), np.bool_)
            if series.fresh != sound.fresh:
                wrong = ~np.isin(series.order, sound.order)
            subject = Subject(message.SENDER, message.NAME)
            self.findings.rows(subject, series, wrong, partial(_describe, series))


def _describe(series: Series, row: int) -> Said:
    data = bytes(series.payload[row])
    right = expected_checksum(series.message, data, STANDARD_ALGORITHMS)
    return _WRONG, {"given": data[0], "right": right}


RULE = Rule(
    id="checksum",
    title=Text("Checksums are right", "校验和正确"),
    purpose=Text(
        "A receiver drops a frame whose checksum is wrong.",
        "接收方会丢弃校验和错误的报文。",
    ),
    clause="Tables 1, 8, 14 and 16",
    severity=Severity.MUST,
    judges=tuple(dict.fromkeys(message.SENDER for message in _PROTECTED)),
    watch=Checksum,
)
