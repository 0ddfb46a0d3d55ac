"""Messages come from the source address that is printed."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.measure.left_over import EXTENDED
from typedcan.judge.measure.presence import nodes_of
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.rules.frames.identifiers import Identifiers, written
from typedcan.judge.rules.frames.sightings import Sighting, Sightings
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_ADDRESS = Text(
    "source address 0x{address:02X}; with this priority, PF and PS the standard has {printed}",
    "源地址为 0x{address:02X};具有该优先级、PF 和 PS 的标准报文为 {printed}",
)


class SourceAddress(Watcher):
    """Collects identifiers that differ from a message's in the lowest eight bits only.

    Whose they are is known at the end, when it is known which messages came.
    """

    def __init__(self, findings: Findings, protocol: Protocol) -> None:
        super().__init__(findings)
        self._messages = protocol.messages
        self._identifiers = Identifiers(protocol)
        self._seen: set[type[Message]] = set()
        self._sightings = Sightings()

    def feed(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        for message in self._messages:
            frames = chunk.frames(message).fresh
            if frames:
                self._seen.add(message)
                self.findings.examine(message.SENDER, frames)
        left = chunk.left_over
        self._sightings.feed(chunk, left, self._identifiers.has_other_address(left.keys))

    def finish(self, end: LogEnd) -> None:  # noqa: ARG002
        """Say which identifiers were meant to be messages."""
        for sighting in self._sightings.all():
            frame_id = sighting.key & ~EXTENDED
            message = self._identifiers.meant(frame_id, self._seen)
            if message is not None:
                self.findings.examine(message.SENDER, sighting.frames)
                same = self._identifiers.with_head(frame_id)
                self.findings.add(_occurrence(message, sighting, same))


def _occurrence(
    message: type[Message], sighting: Sighting, same: Iterable[type[Message]]
) -> Occurrence:
    printed = ", ".join(f"0x{each.FRAME_ID:08X} {each.NAME}" for each in same)
    return Occurrence(
        subject=Subject(message.SENDER, message.NAME, detail=written(sighting.key)),
        start=sighting.start,
        end=sighting.end,
        order=sighting.order,
        frames=sighting.frames,
        measure=sighting.frames,
        text=_ADDRESS,
        values={"address": sighting.key & 0xFF, "printed": printed},
    )


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    return Rule(
        id="source-address",
        title=Text("Messages come from their source address", "报文的源地址与标准一致"),
        purpose=Text(
            "Receivers compare whole identifiers: from another source address the message is not "
            "seen. A frame counts as a message's where its sender has that address in others, or "
            "where the log lacks the message; else it is taken for another node's, as is a "
            "proprietary PGN from an address that no node has.",
            "接收方按完整标识符过滤:源地址不同则收不到该报文。"
            "该源地址属于发送节点,或日志中缺少该报文时,判为该报文的错误;"
            "否则视为其他节点的报文。专用 PGN 的源地址不属于任何节点时,亦视为其他节点的报文。",
        ),
        severity=Severity.MUST,
        judges=nodes_of(protocol),
        watch=partial(SourceAddress, protocol=protocol),
    )
