"""No frame of a periodic message is missing."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from functools import partial

from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.measure.presence import nodes_of, periods_of
from typedcan.judge.measure.steps import Stopped
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.rules.timing.by_turns import watch_periods
from typedcan.judge.rules.timing.step_findings import add_steps
from typedcan.judge.tolerance import SILENCE, Tolerance
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_SHARE = Tolerance(
    name="period-gap.share",
    value=1.5,
    text=Text(
        "periods up to which a frame is late, not lost: the next one is nearer from there on",
        "间隔不超过该倍数的周期视为延迟而非丢帧(超过后更接近下一帧)",
    ),
)
_EXTRA = Tolerance(
    name="period-gap.extra",
    value=0.01,
    unit="s",
    text=Text(
        "allowed beside, for a short period on a busy bus and for the clock of the logger",
        "额外允许的时间,考虑短周期报文在繁忙总线上的等待及记录仪时钟",
    ),
)

_GAP = Text(
    "no frame for {step:.3g} s ({periods:.3g} periods), at most {limit:.3g} s are allowed",
    "{step:.3g} s 内没有报文(周期的 {periods:.3g} 倍),最多允许 {limit:.3g} s",
)
_STOPPED = Text(
    "no frame any more, while {node} goes on for {step:.3g} s ({periods:.3g} periods); "
    "at most {limit:.3g} s are allowed",
    "此后不再有报文,而 {node} 继续发送了 {step:.3g} s(周期的 {periods:.3g} 倍),"
    "最多允许 {limit:.3g} s",
)


def gap_limit(findings: Findings, period: float) -> float:
    """Seconds from which on a step is a gap."""
    return period * findings.limit(_SHARE) + findings.limit(_EXTRA)


class PeriodGap(Watcher):
    """Looks for long steps, and for messages that stop while their node goes on."""

    def __init__(
        self,
        findings: Findings,
        *,
        protocol: Protocol,
        messages: Collection[type[Message]],
        by_frame: bool,
    ) -> None:
        super().__init__(findings)
        self._messages = messages
        self._by_frame = by_frame
        periods = periods_of(protocol)
        self._periods = {each: periods[each] for each in messages if each in periods}

    def feed(self, chunk: Chunk) -> None:
        """Judge the steps that end here."""
        for message in self._messages:
            steps = chunk.timing.of(message, by_frame=self._by_frame)
            if steps is not None and message.PERIOD:
                limit = gap_limit(self.findings, message.PERIOD)
                periods = steps.length / message.PERIOD
                wrong = steps.length > limit
                add_steps(self.findings, steps, wrong, periods, _GAP, {"limit": limit})

    def finish(self, end: LogEnd) -> None:
        """Judge what stopped before its node did."""
        for message, detail, time, order in self._stopped(end):
            node = end.nodes[message.SENDER]
            silent = (each.start for each in node.silences if each.start >= time)
            until = next(silent, node.last)
            period, step = self._periods[message], until - time
            limit = gap_limit(self.findings, period)
            if end.messages[message].frames == 1:
                # One frame shows no period: it is not late, but has to be silent.
                limit = max(limit, self.findings.limit(SILENCE) * period)
            if step > limit:
                self.findings.examine(message.SENDER)
                self.findings.add(
                    Occurrence(
                        subject=Subject(message.SENDER, message.NAME, "", detail),
                        start=time,
                        end=until,
                        order=order,
                        measure=step / period,
                        text=_STOPPED,
                        values={
                            "node": message.SENDER,
                            "step": step,
                            "periods": step / period,
                            "limit": limit,
                        },
                    )
                )

    def _stopped(self, end: LogEnd) -> Iterator[Stopped]:
        """What came last of the messages that are judged."""
        if self._by_frame:
            for message in self._periods:
                if message in end.messages:
                    seen = end.messages[message]
                    yield Stopped(message, "", seen.last, seen.last_order)
        else:
            yield from (each for each in end.stopped if each.message in self._periods)


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    return Rule(
        id="period-gap",
        title=Text("No periodic frame is missing", "周期报文无丢帧"),
        purpose=Text(
            "A receiver works with old values as long as a frame is missing.",
            "报文缺失期间,接收方只能使用旧值。",
        ),
        severity=Severity.MUST,
        judges=nodes_of(protocol),
        tolerances=(_SHARE, _EXTRA),
        watch=partial(watch_periods, protocol=protocol, make=partial(PeriodGap, protocol=protocol)),
    )
