"""Requests are withdrawn once they are answered."""

from __future__ import annotations

from functools import partial

from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.rules.requests.in_force import InForce, Moment, RequestsInForce
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text
from typedcan.wire.protocol import Protocol, Request

_SECONDS = Tolerance(
    name="request-withdrawn.seconds",
    value=10.0,
    unit="s",
    text=Text(
        "From the last of the answers to the withdrawal",
        "从收到全部应答到撤销请求的时间",
    ),
)

_HELD = Text(
    "in force for {held:.1f} s after its answer; {limit:.3g} s are enough",
    "收到应答后请求仍保持 {held:.1f} s,{limit:.3g} s 已足够",
)


class RequestWithdrawn(Watcher):
    """Measures how long each request stays in force after its answer."""

    def __init__(self, findings: Findings, protocol: Protocol) -> None:
        super().__init__(findings)
        self._limit = findings.limit(_SECONDS)
        self._all = [RequestsInForce(request) for request in protocol.requests]

    def feed(self, chunk: Chunk) -> None:
        """Judge the requests that end."""
        for requests in self._all:
            for in_force in requests.feed(chunk):
                answered = _answered(requests.request, in_force)
                if in_force.end and answered:
                    self._judge(requests.request, answered, in_force.end.time)

    def finish(self, end: LogEnd) -> None:
        """Judge the requests that are still in force, where that is too long already."""
        for requests in self._all:
            answered = requests.open and _answered(requests.request, requests.open)
            if answered and end.time - answered.time > self._limit:
                self._judge(requests.request, answered, end.time)

    def _judge(self, request: Request, answered: Moment, end: float) -> None:
        message, field = request.field
        self.findings.examine(message.SENDER)
        held = end - answered.time
        if held <= self._limit:
            return
        found = Occurrence(
            subject=Subject(message.SENDER, message.NAME, message.FIELDS[field].dbc_name),
            start=answered.time,
            end=end,
            order=answered.order,
            measure=held,
            text=_HELD,
            values={"held": held, "limit": self._limit},
        )
        self.findings.add(found)


def _answered(request: Request, in_force: InForce) -> Moment | None:
    """The frame with which the answer was complete."""
    if len(in_force.answers) < len(request.answers):
        return None
    return max(in_force.answers.values(), key=lambda moment: moment.order)


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    return Rule(
        id="request-withdrawn",
        title=Text("Answered requests are withdrawn", "请求在得到应答后撤销"),
        purpose=Text(
            "A request that stays in force keeps its answers on the bus, and what they say does "
            "not change.",
            "持续有效的请求会使应答报文一直占用总线,而应答内容不会变化。",
        ),
        severity=Severity.INFO,
        judges=tuple(dict.fromkeys(request.field.message.SENDER for request in protocol.requests)),
        tolerances=(_SECONDS,),
        watch=partial(RequestWithdrawn, protocol=protocol),
    )
