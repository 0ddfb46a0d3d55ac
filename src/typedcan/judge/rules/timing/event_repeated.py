"""Messages that are sent on events are not sent cyclically."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.measure.asked import requests_of
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_FRAMES = Tolerance(
    name="event-repeated.frames",
    value=10,
    text=Text(
        "frames in a row with the same payload: a few repetitions make sure that one arrives",
        "内容相同的连续帧数:少量重发可确保对方收到",
    ),
)
_APART = Tolerance(
    name="event-repeated.apart",
    value=1.0,
    unit="s",
    text=Text(
        "from frame to frame, from which on it is another event",
        "两帧间隔达到该值时视为另一事件",
    ),
)

_REPEATED = Text(
    "the same {count} times in {seconds:.3g} s, though it is to be sent on events only",
    "{seconds:.3g} s 内重复发送 {count} 次相同内容,而该报文只应由事件触发",
)


@dataclass(slots=True)
class _Run:
    """Frames in a row with the same payload; ``last_order`` is where the last is in the log."""

    start: float
    order: int
    payload: bytes
    end: float
    last_order: int
    count: int


class EventRepeated(Watcher):
    """Looks for runs of frames with the same payload that nobody asked for."""

    def __init__(self, findings: Findings, protocol: Protocol) -> None:
        super().__init__(findings)
        self._events = _events(protocol)
        self._requests = requests_of(protocol)
        self._numbers = {
            message: transfer.frame_number.field
            for transfer in protocol.transfers
            for message in transfer.messages
            if transfer.frame_number and message in self._events
        }
        self._runs: dict[tuple[type[Message], int], _Run] = {}
        self._asked: dict[type[Message], int] = {}  # where in the log it was last asked for

    def feed(self, chunk: Chunk) -> None:
        """Go on with the runs."""
        for message in self._events:
            asked = self._askings(chunk, message)
            series = chunk.frames(message)
            if not series.fresh:
                continue
            self.findings.examine(message.SENDER, series.fresh)
            keys = np.zeros(series.fresh, np.int64)
            if message in self._numbers:
                keys = series.raw(self._numbers[message])[series.first :]
            for key in np.unique(keys).tolist():
                rows = np.flatnonzero(keys == key) + series.first
                frames = series.payload[rows], series.time[rows], series.order[rows]
                self._go_on(message, key, *frames, asked)

    def finish(self, end: LogEnd) -> None:  # noqa: ARG002
        """End all runs."""
        for (message, key), run in self._runs.items():
            self._judge(message, key, run)

    def _askings(self, chunk: Chunk, message: type[Message]) -> NDArray[np.int64]:
        """Where in the log it was asked for: the last time before, and in the chunk."""
        if message not in self._requests:
            return np.empty(0, np.int64)
        request = self._requests[message]
        series = chunk.sound(request.field.message)
        own = series.order[series.raw(request.field.field) == request.code]
        asked = np.concatenate([[self._asked.get(message, -1)], own])
        self._asked[message] = int(asked[-1])
        return asked

    def _go_on(
        self,
        message: type[Message],
        key: int,
        payload: NDArray[np.uint8],
        time: NDArray[np.float64],
        order: NDArray[np.int64],
        asked: NDArray[np.int64],
    ) -> None:
        """Take the frames of one number."""
        run = self._runs.get((message, key))
        if run:
            payload = np.concatenate([np.frombuffer(run.payload, np.uint8)[None, :], payload])
            time, order = np.append(run.end, time), np.append(run.last_order, order)
        step = np.diff(time)
        same = (payload[1:] == payload[:-1]).all(axis=1)
        same &= (step >= 0) & (step < self.findings.limit(_APART))
        same &= np.diff(np.searchsorted(asked, order)) == 0
        begins = np.concatenate([[0], np.flatnonzero(~same) + 1])
        ends = np.concatenate([begins[1:], [len(time)]])
        counts = ends - begins
        long = counts > self.findings.limit(_FRAMES)
        long[[0, -1]] = True
        for begin, end in zip(begins[long].tolist(), ends[long].tolist(), strict=True):
            if begin or run is None:
                run = _Run(
                    float(time[begin]), int(order[begin]), payload[begin].tobytes(), 0.0, 0, 0
                )
                run.count = end - begin
            else:
                run.count += end - 1
            run.end, run.last_order = float(time[end - 1]), int(order[end - 1])
            if end < len(time):
                self._judge(message, key, run)
            self._runs[message, key] = run

    def _judge(self, message: type[Message], key: int, run: _Run) -> None:
        if run.count <= self.findings.limit(_FRAMES):
            return
        self.findings.add(
            Occurrence(
                subject=Subject(
                    message.SENDER,
                    message.NAME,
                    "",
                    f"frame {key}" if message in self._numbers else "",
                ),
                start=run.start,
                end=run.end,
                order=run.order,
                frames=run.count,
                measure=run.count,
                text=_REPEATED,
                values={"count": run.count, "seconds": run.end - run.start},
            )
        )


def _events(protocol: Protocol) -> tuple[type[Message], ...]:
    return tuple(message for message in protocol.messages if not message.PERIOD)


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    return Rule(
        id="event-repeated",
        title=Text("Event messages are not sent cyclically", "事件报文不周期发送"),
        purpose=Text(
            "Who is asked without end answers without end, and the bus carries both.",
            "不断的请求会引起不断的应答,占用总线。",
        ),
        severity=Severity.SHOULD,
        judges=tuple(dict.fromkeys(message.SENDER for message in _events(protocol))),
        tolerances=(_FRAMES, _APART),
        watch=partial(EventRepeated, protocol=protocol),
    )
