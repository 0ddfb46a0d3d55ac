"""Periodic messages load the bus as much as the standard has it."""

from __future__ import annotations

from functools import partial

import numpy as np

from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.measure.presence import nodes_of
from typedcan.judge.measure.traffic import Channel, Traffic, bits_of
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.tolerance import SET_BACK, Tolerance
from typedcan.model.frame_time import Bits
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_SHARE = Tolerance(
    name="bus-load.share",
    value=0.1,
    text=Text("of the load that the periods make", "相对于按周期计算的负载率的比例"),
)

_MORE = Text(
    "its periodic messages load {channel} by {load:.2%}, {expected:.2%} is what their periods make",
    "其周期报文使 {channel} 的负载率为 {load:.2%},按标准周期计算应为 {expected:.2%}",
)


class BusLoad(Watcher):
    """Compares what each node sends on each channel with what the standard asks of it.

    What is sent on events and on request is not judged: how much of it comes is up to who asks.
    """

    def __init__(self, findings: Findings, protocol: Protocol) -> None:
        super().__init__(findings)
        self._nodes = nodes_of(protocol)
        self._last = 0.0
        self._back = 0.0
        self._parts = 1

    def feed(self, chunk: Chunk) -> None:
        """Count the frames."""
        time = chunk.block.timestamp - chunk.begin
        steps = np.diff(time, prepend=self._last)
        # Where the clock was set back, more time passed than the log's end tells.
        back = steps[steps < -self.findings.limit(SET_BACK)]
        self._back -= float(back.sum())
        self._parts += len(back)
        self._last = float(time[-1])

    def finish(self, end: LogEnd) -> None:
        """Judge each node on each channel."""
        seconds = self._last + self._back
        if seconds <= 0:
            return
        for channel in dict.fromkeys(end.traffic.channels.values()):
            messages = end.traffic.always(channel)
            for node in self._nodes:
                own = [message for message in messages if node == message.SENDER]
                if own:
                    self._judge(node, channel, own, seconds, end.traffic)

    def _judge(
        self,
        node: str,
        channel: Channel,
        messages: list[type[Message]],
        seconds: float,
        traffic: Traffic,
    ) -> None:
        sent = expected = once = Bits()
        for message in messages:
            bits = bits_of(message)
            sent = sent.plus(bits, traffic.frames[message])
            expected = expected.plus(bits, traffic.rate(message) * seconds)
            once = once.plus(bits, traffic.per_cycle(message))
        self.findings.examine(node)
        # What begins and ends with a frame has one cycle more than periods.
        more = once.bare * self._parts
        if sent.bare <= expected.bare * (1 + self.findings.limit(_SHARE)) + more:
            return
        name = "" if channel is None else str(channel)
        rate = traffic.bit_rate(channel)
        self.findings.add(
            Occurrence(
                subject=Subject(node, detail=name),
                start=0.0,
                end=seconds,
                order=0,
                frames=sum(traffic.frames[message] for message in messages),
                measure=sent.bare / expected.bare,
                text=_MORE,
                values={
                    "channel": name or "CAN",
                    "load": sent.bare / seconds / rate,
                    "expected": expected.bare / seconds / rate,
                },
            )
        )


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    return Rule(
        id="bus-load",
        title=Text("The bus load is that of the standard", "总线负载符合标准"),
        purpose=Text(
            "A bus with more load than was planned delays all messages of low priority.",
            "总线负载超出设计值会使低优先级报文延迟。",
        ),
        severity=Severity.SHOULD,
        judges=nodes_of(protocol),
        tolerances=(_SHARE,),
        watch=partial(BusLoad, protocol=protocol),
    )
