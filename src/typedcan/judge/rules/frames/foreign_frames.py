"""Frames on the bus that the protocol does not have."""

from __future__ import annotations

from functools import partial

from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.measure.left_over import EXTENDED
from typedcan.judge.measure.presence import nodes_of
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.rules.frames.identifiers import Identifiers, written
from typedcan.judge.rules.frames.sightings import Sightings
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_FOREIGN = Text("frames that the protocol does not have: {frames}", "非本协议报文,共 {frames} 帧")
_AND_MORE = Text(
    "frames that the protocol does not have: {frames}; of further identifiers: {others}",
    "非本协议报文,共 {frames} 帧;其余未列出的标识符共 {others} 帧",
)


class ForeignFrames(Watcher):
    """Collects the identifiers that no rule holds to be meant as a message's."""

    def __init__(self, findings: Findings, protocol: Protocol) -> None:
        super().__init__(findings)
        self._node = findings.first_node
        self._messages = protocol.messages
        self._identifiers = Identifiers(protocol)
        self._seen: set[type[Message]] = set()
        self._sightings = Sightings()

    def feed(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        self.findings.examine(self._node, len(chunk.block))
        self._seen.update(each for each in self._messages if chunk.frames(each).fresh)
        left = chunk.left_over
        self._sightings.feed(chunk, left, self._identifiers.is_foreign(left.keys))

    def finish(self, end: LogEnd) -> None:  # noqa: ARG002
        """Say which identifiers there were."""
        foreign = [
            each
            for each in self._sightings.all()
            if not each.key & EXTENDED
            or self._identifiers.meant(each.key & ~EXTENDED, self._seen) is None
        ]
        for place, each in enumerate(foreign, 1):
            others = self._sightings.others if place == len(foreign) else 0
            found = Occurrence(
                subject=Subject(self._node, detail=written(each.key)),
                start=each.start,
                end=each.end,
                order=each.order,
                frames=each.frames,
                measure=each.frames,
                text=_AND_MORE if others else _FOREIGN,
                values={"frames": each.frames} | ({"others": others} if others else {}),
            )
            self.findings.add(found)


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    return Rule(
        id="foreign-frames",
        title=Text("Other frames on the bus", "总线上的其他报文"),
        purpose=Text(
            "They need not be wrong, but take a share of the bus, and may be messages with a "
            "mistaken identifier.",
            "这些报文不一定有错,但会占用总线带宽,也可能是标识符有误的协议报文。",
        ),
        severity=Severity.INFO,
        judges=nodes_of(protocol),
        watch=partial(ForeignFrames, protocol=protocol),
    )
