"""Messages come from the source address that is printed."""

from __future__ import annotations

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.chunk import Chunk
from swapcan.conform.findings import Findings, Occurrence, Subject
from swapcan.conform.rule import Rule, Severity, Watcher
from swapcan.conform.rules.frames.identifiers import has_other_address, meant, with_head, written
from swapcan.conform.rules.frames.left_over import EXTENDED, left_over
from swapcan.conform.rules.frames.sightings import Sighting, Sightings
from swapcan.conform.text import Text
from typedcan.wire.message import Message

_ADDRESS = Text(
    "source address 0x{address:02X}; with this priority, PF and PS the standard has {printed}",
    "源地址为 0x{address:02X};具有该优先级、PF 和 PS 的标准报文为 {printed}",
)


class SourceAddress(Watcher):
    """Collects identifiers that differ from a message's in the lowest eight bits only.

    Whose they are is known at the end, when it is known which messages came.
    """

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._seen: set[type[Message]] = set()
        self._sightings = Sightings()

    def take(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        for message in PROTOCOL.messages:
            frames = chunk.frames(message).fresh
            if frames:
                self._seen.add(message)
                self.findings.examine(message.SENDER, frames)
        left = left_over(chunk)
        self._sightings.take(chunk, left, has_other_address(left.keys))

    def finish(self, end: float) -> None:  # noqa: ARG002
        """Say which identifiers were meant to be messages."""
        for sighting in self._sightings.all():
            message = meant(sighting.key & ~EXTENDED, self._seen)
            if message is not None:
                self.findings.examine(message.SENDER, sighting.frames)
                self.findings.add(_occurrence(message, sighting))


def _occurrence(message: type[Message], sighting: Sighting) -> Occurrence:
    frame_id = sighting.key & ~EXTENDED
    printed = ", ".join(f"0x{each.FRAME_ID:08X} {each.NAME}" for each in with_head(frame_id))
    return Occurrence(
        subject=Subject(message.SENDER, message.NAME, detail=written(sighting.key)),
        start=sighting.start,
        end=sighting.end,
        order=sighting.order,
        frames=sighting.frames,
        measure=sighting.frames,
        text=_ADDRESS,
        values={"address": frame_id & 0xFF, "printed": printed},
    )


RULE = Rule(
    id="source-address",
    title=Text("Messages come from their source address", "报文的源地址与标准一致"),
    purpose=Text(
        "Receivers compare whole identifiers: from another source address the message is not seen. "
        "V2B_RQData comes from 0xEF, BMS_TMS_0 from 0xF4, unlike the rest of their senders' "
        "messages. A frame counts as a message's where its sender has that address in others, or "
        "where the log lacks the message; else it is taken for another node's.",
        "接收方按完整标识符过滤:源地址不同则收不到该报文。"
        "V2B_RQData 的源地址为 0xEF,BMS_TMS_0 为 0xF4,"
        "与其发送节点的其他报文不同。该源地址属于发送节点,或日志中缺少该报文时,判为该报文的错误;"
        "否则视为其他节点的报文。",
    ),
    clause="A.1",
    severity=Severity.MUST,
    judges=PROTOCOL.nodes,
    watch=SourceAddress,
)
