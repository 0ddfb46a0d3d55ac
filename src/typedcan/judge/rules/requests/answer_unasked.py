"""What answers a request comes only when it was asked for."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.measure.presence import sent_by
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.rules.requests.in_force import InForce, Moment, RequestsInForce
from typedcan.judge.series import Series
from typedcan.judge.tolerance import Tolerance
from typedcan.model.protocol import SendType
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol, Request

_SECONDS = Tolerance(
    name="answer-unasked.seconds",
    value=2.0,
    unit="s",
    text=Text(
        "From the withdrawal of a request to the last frame of its answers",
        "从撤销请求到最后一帧应答的时间",
    ),
)
_BEGIN = Tolerance(
    name="answer-unasked.begin",
    value=10.0,
    unit="s",
    text=Text(
        "How long a log must go on with neither the request nor the answer before the request "
        "counts as not made; a log can begin while a request is in force",
        "记录开始后多长时间既无请求也无应答,才视为没有请求;记录可能在请求有效期间开始",
    ),
)
_ALWAYS = Tolerance(
    name="answer-unasked.always",
    value=0.8,
    text=Text(
        "Share of the frames of its period from which on an answer counts as sent all the time",
        "应答帧数达到按周期应有帧数的该比例时,视为始终周期发送",
    ),
)
_SEVERAL = Tolerance(
    name="answer-unasked.frames",
    value=3,
    text=Text("Frames that it takes to show a period", "判断周期所需的最少帧数"),
)

_UNASKED = Text(
    "sent {ago:.3g} s after the last request of the {asker} ended, {limit:.3g} s are allowed",
    "在 {asker} 撤销请求 {ago:.3g} s 后仍发送,允许 {limit:.3g} s",
)
_NEVER = Text(
    "sent though the {asker} has not asked since the log began, {ago:.3g} s before",
    "{asker} 未请求而发送:记录开始后 {ago:.3g} s 内没有请求",
)


class AnswerUnasked(Watcher):
    """Holds the frames of the answers against the requests in force."""

    def __init__(self, findings: Findings, protocol: Protocol) -> None:
        super().__init__(findings)
        self._all = [_Asking(request, protocol, findings) for request in protocol.requests]

    def feed(self, chunk: Chunk) -> None:
        """Judge the answers for which it is known whether they were asked for."""
        for asking in self._all:
            asking.feed(chunk)

    def finish(self, end: LogEnd) -> None:
        """Say of which answers some were not."""
        for asking in self._all:
            asking.finish(end)


class _Asking:
    """One request and its answers."""

    def __init__(self, request: Request, protocol: Protocol, findings: Findings) -> None:
        self._request = request
        # What is sent all the time needs no request, though one may ask for it.
        self._answers = [
            each for each in request.answers if each.MODEL.send_type is not SendType.CYCLIC
        ]
        self._askers = sent_by(protocol, request.field.message.SENDER)
        self._findings = findings
        self._limit = findings.limit(_SECONDS)
        self._begin = findings.limit(_BEGIN)
        self._requests = RequestsInForce(request)
        self._last: InForce | None = None
        self._asker: Moment | None = None  # the first frame of the node that asks
        self._first: Moment | None = None  # the first frame of the request's message
        self._answered: dict[type[Message], float] = {}  # when each answer came first
        self._found = {answer: findings.apart() for answer in self._answers}

    def feed(self, chunk: Chunk) -> None:
        message = self._request.field.message
        if self._asker is None:
            self._asker = _earliest(chunk, self._askers)
        if self._first is None:
            self._first = _earliest(chunk, (message,))
        requests = self._requests.feed(chunk)
        if self._last and self._last not in requests:
            requests.insert(0, self._last)
        self._last = requests[-1] if requests else None
        for answer in self._answers:
            series = chunk.frames(answer)
            if series.fresh:
                self._answered.setdefault(answer, float(series.time[series.first]))
            if series.fresh and self._asker:
                self._judge(series, self._asker, requests)

    def finish(self, end: LogEnd) -> None:
        """What came at its period for as long as its sender did was sent as it is printed."""
        always, several = self._findings.limit(_ALWAYS), self._findings.limit(_SEVERAL)
        for answer, found in self._found.items():
            if answer in end.messages and answer.PERIOD:
                seconds = end.nodes[answer.SENDER].seconds
                due = seconds / answer.PERIOD
                if found.count and end.messages[answer].frames >= max(always * due, several):
                    continue
            self._findings.take(found)

    def _judge(self, series: Series, asker: Moment, requests: Sequence[InForce]) -> None:
        ended = _ended(series, requests)
        asked = series.time <= ended + self._limit
        known = asked | ((series.order > asker.order) & self._known(series))
        unknown = series.fresh - int(known[series.first :].sum())
        if unknown == series.fresh:
            return
        ago = series.time - np.where(np.isneginf(ended), 0.0, ended)

        def describe(row: int) -> Said:
            values = {
                "ago": float(ago[row]),
                "asker": self._request.field.message.SENDER,
                "limit": self._limit,
            }
            return _NEVER if np.isneginf(ended[row]) else _UNASKED, values

        message = series.message
        subject = Subject(message.SENDER, message.NAME)
        found = self._found[message]
        found.rows(subject, series, known & ~asked, describe, ago)
        found.examine(message.SENDER, -unknown)  # those were not judged

    def _known(self, series: Series) -> NDArray[np.bool_]:
        """Whether a frame comes so late that a request must have been seen."""
        # What came from the begin on may have been asked for before the log.
        is_new = self._answered[series.message] > self._begin
        known: NDArray[np.bool_] = np.full(len(series), is_new)
        if self._first:
            # The first frame may have withdrawn a request from before the log.
            after = series.order > self._first.order
            known |= after & (series.time > self._first.time + self._limit)
        return known


def _ended(series: Series, requests: Sequence[InForce]) -> NDArray[np.float64]:
    """When the last request before each frame ended: inf for not yet, -inf for there was none."""
    if not requests:
        return np.full(len(series), -np.inf)
    begins = np.array([in_force.begin.order for in_force in requests])
    ends = np.array(
        [-np.inf, *(in_force.end.time if in_force.end else np.inf for in_force in requests)]
    )
    return ends[np.searchsorted(begins, series.order)]


def _earliest(chunk: Chunk, messages: Iterable[type[Message]]) -> Moment | None:
    """The first frame of some messages in a chunk."""
    all_series = [chunk.frames(message) for message in messages]
    found = [
        Moment(float(series.time[0]), int(series.order[0])) for series in all_series if series.fresh
    ]
    return min(found, key=lambda moment: moment.order, default=None)


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    return Rule(
        id="answer-unasked",
        title=Text("Answers come only when asked for", "仅在请求后发送应答"),
        purpose=Text(
            "Answers are sent at the wish of the other node and only load the bus otherwise.",
            "应答按对方需求发送;否则只会增加总线负载。",
        ),
        severity=Severity.SHOULD,
        judges=tuple(dict.fromkeys(request.answers[0].SENDER for request in protocol.requests)),
        tolerances=(_SECONDS, _BEGIN, _ALWAYS, _SEVERAL),
        watch=partial(AnswerUnasked, protocol=protocol),
    )
