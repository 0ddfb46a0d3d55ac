"""A node sends each periodic message that the standard gives it."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.measure.presence import Presence, nodes_of, periods_of
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_PERIODS = Tolerance(
    name="message-missing.periods",
    value=3,
    text=Text(
        "periods that a node sends without the message, so that one lost frame is not enough",
        "节点在线但没有该报文的周期数,避免因丢失一帧而误判",
    ),
)

_MISSING = Text(
    "never comes in {seconds:.3g} s in which {node} sends, every {period:.3g} s is printed",
    "{node} 发送报文的 {seconds:.3g} s 内从未出现,标准规定周期为 {period:.3g} s",
)


class MessageMissing(Watcher):
    """Looks for messages that never come.

    A log need not have all buses: a message is judged where a receiver of it sends too, or its
    sender sends something else to the same receiver.
    """

    def __init__(self, findings: Findings, protocol: Protocol) -> None:
        super().__init__(findings)
        self._periods = periods_of(protocol)

    def feed(self, chunk: Chunk) -> None:
        """Nothing is missing before the end."""

    def finish(self, end: LogEnd) -> None:
        """Judge all messages."""
        for message, period in self._periods.items():
            sender = end.nodes.get(message.SENDER)
            if sender is None:
                continue
            if message in end.messages:
                self.findings.examine(message.SENDER)
                continue
            there = max((seen.seconds for seen in _others(message, end)), default=0.0)
            seconds = min(sender.seconds, there)
            if seconds > self.findings.limit(_PERIODS) * period:
                self.findings.examine(message.SENDER)
                self._found(message, period, sender, seconds)

    def _found(
        self, message: type[Message], period: float, sender: Presence, seconds: float
    ) -> None:
        self.findings.add(
            Occurrence(
                subject=Subject(message.SENDER, message.NAME),
                start=sender.first,
                end=sender.last,
                order=sender.first_order,
                measure=seconds / period,
                text=_MISSING,
                values={"seconds": seconds, "node": message.SENDER, "period": period},
            )
        )


def _others(message: type[Message], end: LogEnd) -> Iterable[Presence]:
    """What shows that the log has the bus on which a message is due."""
    for node in message.RECEIVERS:
        if node in end.nodes:
            yield end.nodes[node]
    for other, seen in end.messages.items():
        if other.SENDER == message.SENDER and set(other.RECEIVERS) & set(message.RECEIVERS):
            yield seen


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    return Rule(
        id="message-missing",
        title=Text("All periodic messages are sent", "周期报文齐全"),
        purpose=Text(
            "A receiver waits for each message that the standard prints.",
            "接收方等待标准规定的每个报文。",
        ),
        severity=Severity.MUST,
        judges=nodes_of(protocol),
        tolerances=(_PERIODS,),
        watch=partial(MessageMissing, protocol=protocol),
    )
