"""Error frames on the bus."""

from __future__ import annotations

from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.measure.presence import nodes_of
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.report.language import Text
from typedcan.wire.protocol import Protocol

_ERRORS = Text(
    "error frames: {count}, from {first:.3f} s to {last:.3f} s",
    "错误帧共 {count} 个,从 {first:.3f} s 到 {last:.3f} s",
)


class ErrorFrames(Watcher):
    """Counts error frames; which node caused them no log tells."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._node = findings.first_node
        self._count = 0
        self._order = 0
        self._first = self._last = 0.0

    def feed(self, chunk: Chunk) -> None:
        """Count those of the next frames."""
        self.findings.examine(self._node, len(chunk.block))
        rows = chunk.left_over.errors
        if not len(rows):
            return
        times = chunk.block.timestamp[rows] - chunk.begin
        if not self._count:
            self._order = int(rows[0]) + chunk.first_order
            self._first = float(times[0])
        self._last = float(times[-1])
        self._count += len(rows)

    def finish(self, end: LogEnd) -> None:  # noqa: ARG002
        """Say how many there were."""
        if not self._count:
            return
        found = Occurrence(
            subject=Subject(self._node),
            start=self._first,
            end=self._last,
            order=self._order,
            frames=self._count,
            measure=self._count,
            text=_ERRORS,
            values={"count": self._count, "first": self._first, "last": self._last},
        )
        self.findings.add(found)


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    return Rule(
        id="error-frames",
        title=Text("Error frames", "错误帧"),
        purpose=Text(
            "They tell of bad wiring, a wrong bit rate, or two nodes that send the same "
            "identifier.",
            "错误帧说明线路不良、波特率不一致,或有两个节点发送同一标识符。",
        ),
        severity=Severity.INFO,
        judges=nodes_of(protocol),
        watch=ErrorFrames,
    )
