"""Periodic messages load the bus as much as the standard has it."""

from __future__ import annotations

import numpy as np

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.chunk import Chunk
from swapcan.conform.findings import Findings, Occurrence, Subject
from swapcan.conform.measure.load import BIT_RATE
from swapcan.conform.measure.traffic import Channel, Traffic
from swapcan.conform.rule import Rule, Severity, Watcher
from swapcan.conform.text import Text
from swapcan.conform.tolerance import Tolerance
from typedcan.model.frame_time import Bits
from typedcan.wire.message import Message

_SHARE = Tolerance(
    name="bus-load.share",
    value=0.1,
    text=Text("of the load that the periods make", "相对于按周期计算的负载率的比例"),
)

_SET_BACK = 1.0
"""Seconds; less is disorder between the channels of a log."""

_MORE = Text(
    "its periodic messages load {channel} by {load:.2%}, {expected:.2%} is what their periods make",
    "其周期报文使 {channel} 的负载率为 {load:.2%},按标准周期计算应为 {expected:.2%}",
)


class BusLoad(Watcher):
    """Compares what each node sends on each channel with what the standard asks of it.

    What is sent on events and on request is not judged: how much of it comes is up to who asks.
    """

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._traffic = Traffic()
        self._last = 0.0
        self._back = 0.0
        self._parts = 1

    def take(self, chunk: Chunk) -> None:
        """Count the frames."""
        self._traffic.take(chunk)
        time = chunk.block.timestamp - chunk.begin
        steps = np.diff(time, prepend=self._last)
        # Where the clock was set back, more time passed than the log's end tells.
        back = steps[steps < -_SET_BACK]
        self._back -= float(back.sum())
        self._parts += len(back)
        self._last = float(time[-1])

    def finish(self, end: float) -> None:  # noqa: ARG002
        """Judge each node on each channel."""
        seconds = self._last + self._back
        if seconds <= 0:
            return
        for channel in dict.fromkeys(self._traffic.channels.values()):
            messages = self._traffic.always(channel)
            for node in PROTOCOL.nodes:
                own = [message for message in messages if node == message.SENDER]
                if own:
                    self._judge(node, channel, own, seconds)

    def _judge(
        self, node: str, channel: Channel, messages: list[type[Message]], seconds: float
    ) -> None:
        sent = expected = once = Bits()
        for message in messages:
            bits = Bits.of(message.LENGTH, extended=True)
            sent = sent.plus(bits, self._traffic.frames[message])
            expected = expected.plus(bits, self._traffic.rate(message) * seconds)
            once = once.plus(bits, self._traffic.per_cycle(message))
        self.findings.examine(node)
        # What begins and ends with a frame has one cycle more than periods.
        more = once.bare * self._parts
        if sent.bare <= expected.bare * (1 + self.findings.limit(_SHARE)) + more:
            return
        name = "" if channel is None else str(channel)
        self.findings.add(
            Occurrence(
                subject=Subject(node, detail=name),
                start=0.0,
                end=seconds,
                order=0,
                frames=sum(self._traffic.frames[message] for message in messages),
                measure=sent.bare / expected.bare,
                text=_MORE,
                values={
                    "channel": name or "CAN",
                    "load": sent.bare / seconds / BIT_RATE,
                    "expected": expected.bare / seconds / BIT_RATE,
                },
            )
        )


RULE = Rule(
    id="bus-load",
    title=Text("The bus load is that of the standard", "总线负载符合标准"),
    purpose=Text(
        "A bus with more load than was planned delays all messages of low priority.",
        "总线负载超出设计值会使低优先级报文延迟。",
    ),
    clause="A.1, 4.2.2",
    severity=Severity.SHOULD,
    judges=PROTOCOL.nodes,
    tolerances=(_SHARE,),
    watch=BusLoad,
)
