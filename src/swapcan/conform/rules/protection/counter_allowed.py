"""Alive counters never hold the code that says Signal Invalid."""

from __future__ import annotations

from functools import partial

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.chunk import Chunk
from swapcan.conform.findings import Said, Subject
from swapcan.conform.rule import Rule, Severity, Watcher
from swapcan.conform.series import Series
from swapcan.conform.text import Text
from typedcan.wire.message import Counter

_LIMITED = tuple(
    (message, counter)
    for message in PROTOCOL.messages
    if (counter := message.COUNTER) and counter.modulus < 1 << message.FIELDS[counter.field].length
)

_FORBIDDEN = Text(
    "the counter is {value}; it runs from 0 to {last}", "计数值为 {value},应在 0~{last} 之间"
)


class CounterAllowed(Watcher):
    """Looks for counters at or above their modulus."""

    def take(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        for message, counter in _LIMITED:
            series = chunk.sound(message)
            wrong = series.raw(counter.field) >= counter.modulus
            subject = Subject(message.SENDER, message.NAME, counter.dbc_name)
            self.findings.rows(subject, series, wrong, partial(_describe, series, counter))


def _describe(series: Series, counter: Counter, row: int) -> Said:
    value = int(series.raw(counter.field)[row])
    return _FORBIDDEN, {"value": value, "last": counter.modulus - 1}


RULE = Rule(
    id="counter-allowed",
    title=Text("Alive counters are valid", "生命信号有效"),
    purpose=Text(
        "15 says Signal Invalid: a receiver cannot tell from it that the sender is alive.",
        "15 表示信号无效,接收方无法据此判断发送方是否正常工作。",
    ),
    clause="Table 1 row 8 (5.1.1), Table 14 row 2 (5.2.1)",
    severity=Severity.MUST,
    judges=tuple(dict.fromkeys(message.SENDER for message, _ in _LIMITED)),
    watch=CounterAllowed,
)
