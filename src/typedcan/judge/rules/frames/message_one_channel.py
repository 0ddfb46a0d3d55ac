"""Each message comes on one channel of the log."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.measure.channels import Formats, has_length
from typedcan.judge.measure.presence import nodes_of
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.rules.frames.sightings import Sighting
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_TWICE = Text(
    "frames on {channel} that are not judged: {frames}; those on {home} are",
    "通道 {channel} 上的 {frames} 帧不参与判定,只判定通道 {home} 上的报文",
)


class MessageOneChannel(Watcher):
    """Counts the frames that are sound but came on another channel than the first."""

    def __init__(self, findings: Findings, protocol: Protocol) -> None:
        super().__init__(findings)
        self._messages = protocol.messages
        self._formats = Formats(protocol)
        self._first: dict[type[Message], str] = {}
        self._others: dict[tuple[type[Message], str], Sighting] = {}

    def feed(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        block = chunk.block
        for message in self._messages:
            own = chunk.frames(message)
            if not own.fresh:
                continue
            self.findings.examine(message.SENDER, own.fresh)
            if message not in self._first:
                row = own.order[own.first] - chunk.first_order
                self._first[message] = str(block.channels[block.channel[row]])
        for message, rows in chunk.left_over.of_messages():
            sound = self._formats.fit(message, block, rows) & has_length(message, block, rows)
            if message in self._first and sound.any():
                self._count(chunk, message, rows[sound])

    def finish(self, end: LogEnd) -> None:  # noqa: ARG002
        """Say which channels there were."""
        for (message, channel), each in self._others.items():
            home = self._first[message]
            found = Occurrence(
                subject=Subject(message.SENDER, message.NAME, detail=channel),
                start=each.start,
                end=each.end,
                order=each.order,
                frames=each.frames,
                measure=each.frames,
                text=_TWICE,
                values={"channel": channel, "frames": each.frames, "home": home},
            )
            self.findings.add(found)

    def _count(self, chunk: Chunk, message: type[Message], rows: NDArray[np.int64]) -> None:
        block = chunk.block
        channels = block.channel[rows]
        for number in np.unique(channels).tolist():
            own = rows[channels == number]
            times = block.timestamp[own] - chunk.begin
            start, end, order = float(times[0]), float(times[-1]), int(own[0]) + chunk.first_order
            key = message, str(block.channels[number])
            sighting = self._others.setdefault(key, Sighting(message.FRAME_ID, start, end, order))
            sighting.end = end
            sighting.frames += len(own)


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    return Rule(
        id="message-one-channel",
        title=Text("Each message comes on one channel", "每个报文只在一个通道上"),
        purpose=Text(
            "A message that is on several channels of a log, as behind a gateway, is judged on the "
            "first only.",
            "报文出现在日志的多个通道上时(例如经网关转发),只判定最先出现的通道。",
        ),
        severity=Severity.INFO,
        judges=nodes_of(protocol),
        watch=partial(MessageOneChannel, protocol=protocol),
    )
