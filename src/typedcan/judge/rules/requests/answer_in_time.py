"""Requests are answered, with all that was asked for, in time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.measure.presence import sent_by
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.rules.requests.in_force import InForce, RequestsInForce, first_after
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol, Request

_SECONDS = Tolerance(
    name="answer-in-time.seconds",
    value=2.0,
    unit="s",
    text=Text(
        "From a request to the last of its answers",
        "从发出请求到收到全部应答的时间",
    ),
)

_MISSING = Text(
    "no {missing} within {limit:.3g} s of the request",
    "请求发出后 {limit:.3g} s 内未收到 {missing}",
)


_SOME = 4096
"""Frames that are looked through at a time."""


class AnswerInTime(Watcher):
    """Waits for the answers to each request that begins."""

    def __init__(self, findings: Findings, protocol: Protocol) -> None:
        super().__init__(findings)
        limit = findings.limit(_SECONDS)
        self._waits = [
            _Wait(RequestsInForce(request), sent_by(protocol, _asked(request)), findings, limit)
            for request in protocol.requests
        ]

    def feed(self, chunk: Chunk) -> None:
        """Judge the requests whose time is over, or that were answered."""
        for wait in self._waits:
            wait.feed(chunk)


@dataclass(slots=True)
class _Wait:
    """What is waited for, for one kind of request.

    ``own`` are the messages of the node that is asked; ``seen`` says whether it sent anything
    since the request began.
    """

    requests: RequestsInForce
    own: Sequence[type[Message]]
    findings: Findings
    limit: float
    judged: InForce | None = None
    seen: bool = False

    def feed(self, chunk: Chunk) -> None:
        for in_force in self.requests.feed(chunk):
            if in_force is self.judged:
                continue
            if in_force.begin.order >= chunk.first_order:
                self.seen = False
            if self._settle(in_force, chunk):
                self.judged = in_force

    def _settle(self, in_force: InForce, chunk: Chunk) -> bool:
        """Judge a request as far as it can be; whether it is settled."""
        over = _first_later(chunk, in_force, in_force.begin.time + self.limit)
        last = over if in_force.end is None else min(over or in_force.end.order, in_force.end.order)
        request = self.requests.request
        missing = [
            answer
            for answer in request.answers
            if answer not in in_force.answers
            or (last is not None and in_force.answers[answer].order >= last)
        ]
        if not missing:
            self.findings.examine(_asked(request))
            return True
        self.seen = self.seen or self._sent_anything(chunk, in_force.begin.order, last)
        if last is None:
            return False
        if last == over and self.seen:
            self._blame(request, in_force, missing)
        return True

    def _sent_anything(self, chunk: Chunk, after: int, before: int | None) -> bool:
        """Whether the node that is asked sent a frame of any kind, between two others."""
        for message in self.own:
            series = chunk.frames(message)
            row = first_after(series.order, after)
            if row is not None and (before is None or series.order[row] < before):
                return True
        return False

    def _blame(self, request: Request, in_force: InForce, missing: list[type[Message]]) -> None:
        message, field = request.field
        node = _asked(request)
        self.findings.examine(node)
        found = Occurrence(
            subject=Subject(node, message.NAME, message.FIELDS[field].dbc_name),
            start=in_force.begin.time,
            end=in_force.begin.time + self.limit,
            order=in_force.begin.order,
            measure=float(len(missing)),
            text=_MISSING,
            values={
                "missing": ", ".join(answer.NAME for answer in missing),
                "limit": self.limit,
            },
        )
        self.findings.add(found)


def _asked(request: Request) -> str:
    """The node that is to answer."""
    return request.answers[0].SENDER


def _first_later(chunk: Chunk, in_force: InForce, time: float) -> int | None:
    """The number of the first frame of a chunk that comes in a in_force but later than a time."""
    if chunk.end <= time:
        return None
    begin = max(0, in_force.begin.order + 1 - chunk.first_order)
    for start in range(begin, len(chunk.block), _SOME):  # it is seldom far
        late = chunk.block.timestamp[start : start + _SOME] - chunk.begin > time
        if late.any():
            return chunk.first_order + start + int(np.argmax(late))
    return None


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    return Rule(
        id="answer-in-time",
        title=Text("Requests are answered in time", "请求得到及时应答"),
        purpose=Text(
            "Who asks waits for all messages of the answer. A node that is not on the bus, and a "
            "request withdrawn before its time, are not judged.",
            "请求方需要收到全部应答报文。不在总线上的节点以及提前撤销的请求不作判定。",
        ),
        severity=Severity.MUST,
        judges=tuple(dict.fromkeys(_asked(request) for request in protocol.requests)),
        tolerances=(_SECONDS,),
        watch=partial(AnswerInTime, protocol=protocol),
    )
