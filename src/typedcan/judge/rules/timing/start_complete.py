"""A node that begins to send soon sends all of its periodic messages."""

from __future__ import annotations

import math
from functools import partial

from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.measure.presence import Start, nodes_of, periods_of
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.series import Series
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_QUIET = Tolerance(
    name="start-complete.quiet",
    value=1.0,
    unit="s",
    text=Text(
        "without a frame of the node at the log's begin, before it counts as started in the log",
        "日志开始后节点在此时间内没有报文,之后的首帧才视为启动",
    ),
)
_PERIODS = Tolerance(
    name="start-complete.periods",
    value=2,
    text=Text(
        "periods of a message up to its first frame: one to come up, one for a lost frame",
        "首帧出现前允许的周期数:一个用于启动,一个用于丢帧",
    ),
)
_EXTRA = Tolerance(
    name="start-complete.extra",
    value=0.5,
    unit="s",
    text=Text("allowed beside, for the tasks of a node that starts", "额外允许的节点启动时间"),
)

_LATE = Text(
    "first frame {step:.3g} s after {node} began to send, at most {limit:.3g} s are allowed",
    "{node} 开始发送 {step:.3g} s 后才出现首帧,最多允许 {limit:.3g} s",
)
_NEVER = Text(
    "no frame in the {step:.3g} s in which {node} sends, at most {limit:.3g} s are allowed",
    "{node} 发送报文的 {step:.3g} s 内没有该报文,最多允许 {limit:.3g} s",
)


class StartComplete(Watcher):
    """Waits for the first frame of each message after each start of its node."""

    def __init__(self, findings: Findings, protocol: Protocol) -> None:
        super().__init__(findings)
        self._periods = periods_of(protocol)
        self._waiting: dict[type[Message], Start] = {}
        self._never: list[tuple[type[Message], Start, float]] = []

    def feed(self, chunk: Chunk) -> None:
        """Judge the first frames that are here."""
        for start in chunk.timing.starts:
            for message in self._periods:
                if start.node == message.SENDER:
                    self._look(chunk.frames(message), start.order)
                    self._give_up(message, start.after.start if start.after else start.time)
                    if start.after or start.time >= self.findings.limit(_QUIET):
                        self._waiting[message] = start
        for message in tuple(self._waiting):
            self._look(chunk.frames(message), math.inf)

    def finish(self, end: LogEnd) -> None:
        """Judge what never came, if it is a message that the node sends at all."""
        for message in tuple(self._waiting):
            self._give_up(message, end.nodes[message.SENDER].last)
        for message, start, until in self._never:
            if message in end.messages:
                self._judge(message, start, until, start.order, _NEVER)

    def _look(self, series: Series, until: float) -> None:
        """Judge the first frame since the start, if it comes before a frame of the log."""
        start = self._waiting.get(series.message)
        if start is None:
            return
        row = int(series.order.searchsorted(start.order))
        if row < len(series) and series.order[row] < until:
            del self._waiting[series.message]
            time, order = float(series.time[row]), int(series.order[row])
            self._judge(series.message, start, time, order, _LATE)

    def _give_up(self, message: type[Message], end: float) -> None:
        """Wait no more: the node fell silent, or the log ends."""
        start = self._waiting.pop(message, None)
        if start and end - start.time > self._limit(message):
            self._never.append((message, start, end))

    def _judge(
        self, message: type[Message], start: Start, end: float, order: int, text: Text
    ) -> None:
        step, limit = end - start.time, self._limit(message)
        self.findings.examine(message.SENDER)
        if step > limit:
            self.findings.add(
                Occurrence(
                    subject=Subject(message.SENDER, message.NAME),
                    start=start.time,
                    end=end,
                    order=order,
                    measure=step / self._periods[message],
                    text=text,
                    values={"step": step, "limit": limit, "node": message.SENDER},
                )
            )

    def _limit(self, message: type[Message]) -> float:
        periods = self.findings.limit(_PERIODS) * self._periods[message]
        return periods + self.findings.limit(_EXTRA)


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    return Rule(
        id="start-complete",
        title=Text("A node that starts sends all its messages", "节点启动后报文齐全"),
        purpose=Text(
            "Others can work with a node only when they have all of its messages.",
            "其他节点收齐其全部报文后才能正常工作。",
        ),
        severity=Severity.MUST,
        judges=nodes_of(protocol),
        tolerances=(_QUIET, _PERIODS, _EXTRA),
        watch=partial(StartComplete, protocol=protocol),
    )
