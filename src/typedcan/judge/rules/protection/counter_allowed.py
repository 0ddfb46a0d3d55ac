"""Alive counters never hold the code that says Signal Invalid."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.series import Series
from typedcan.logs.checksums import counter_places
from typedcan.model.protection import Counter
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_FORBIDDEN = Text(
    "the counter is {value}; it runs from {first} to {last}",
    "计数值为 {value},应在 {first}~{last} 之间",
)


class CounterAllowed(Watcher):
    """Looks for values that a counter does not run through."""

    def __init__(
        self, findings: Findings, counters: Sequence[tuple[type[Message], Counter]]
    ) -> None:
        super().__init__(findings)
        self._counters = counters

    def feed(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        for message, counter in self._counters:
            series = chunk.sound(message)
            raw = series.raw(message.field_of(counter.signal).name)
            wrong = counter_places(counter, raw) < 0
            subject = Subject(message.SENDER, message.NAME, counter.signal)
            self.findings.rows(subject, series, wrong, partial(_describe, series, counter))


def _describe(series: Series, counter: Counter, row: int) -> Said:
    value = int(series.raw(series.message.field_of(counter.signal).name)[row])
    return _FORBIDDEN, {"value": value, "first": counter.first, "last": counter.last}


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    limited = tuple(
        (message, counter)
        for message in protocol.messages
        if (counter := message.COUNTER)
        and counter.modulus < 1 << message.field_of(counter.signal).length
    )
    return Rule(
        id="counter-allowed",
        title=Text("Alive counters are valid", "生命信号有效"),
        purpose=Text(
            "A receiver cannot tell from a value beyond the last that the sender is alive.",
            "超出计数范围的值不能说明发送方正常工作。",
        ),
        severity=Severity.MUST,
        judges=tuple(dict.fromkeys(message.SENDER for message, _ in limited)),
        watch=partial(CounterAllowed, counters=limited),
    )
