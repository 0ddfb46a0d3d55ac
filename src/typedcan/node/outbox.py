"""What a node sends: cyclic messages, messages that go out once, and answers to requests."""

from __future__ import annotations

import heapq
import itertools
import math
import threading
from collections.abc import Iterable, Mapping, Sequence

from typedcan.node.clock import Clock
from typedcan.node.cycles import Cycles, Maker, Source, frames_of
from typedcan.node.life import Life
from typedcan.node.port import Port
from typedcan.node.transmit import Transmitter
from typedcan.wire.errors import SendingError
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_ANSWER_GAP = 0.005
"""Seconds between the frames of an answer that is sent once."""

_AT_MOST = 0.1
"""Seconds to wait for somebody who changes what is sent."""


class Outbox:
    """What a node sends and when; `run` sends what is due. Any thread may change what is sent.

    Parameters
    ----------
    protocol, name
        Whose messages, and the node that sends them.
    """

    def __init__(
        self,
        protocol: Protocol,
        name: str,
        transmitter: Transmitter,
        port: Port,
        clock: Clock,
    ) -> None:
        self._name = name
        self._may_send = frozenset(protocol.sent_by(name))
        self._transmitter = transmitter
        self._clock = clock
        self._changed = threading.Condition(threading.RLock())
        # Each node begins elsewhere, so that nodes that are started together keep apart too.
        phase = protocol.nodes.index(name) / len(protocol.nodes)
        self.cycles = Cycles(transmitter, port, clock, self._changed, phase=phase)
        self._once: list[tuple[float, int, Message]] = []
        self._number = itertools.count()
        self._last: dict[type[Message], Message] = {}
        self._answers: dict[type[Message], Source] = {}
        self._asked: set[type[Message]] = set()
        self.closed = ""
        """Why nothing is taken any more; empty while it is."""

    @property
    def next_due(self) -> float:
        """When `run` has something to do; `math.inf` for never."""
        with self._changed:
            return min(self.cycles.next_due, self._once[0][0] if self._once else math.inf)

    def set(self, messages: Iterable[Message], period: float | None) -> None:
        """See `Node.set`."""
        self.check_open()
        self.put(messages, period)

    def put(self, messages: Iterable[Message], period: float | None) -> None:
        """The same, also where nothing is taken from others any more."""
        by_kind = self._checked(messages)
        _check_period(period)
        with self._changed:
            for kind, frames in by_kind.items():
                every = period or self.cycles.period(kind) or kind.PERIOD
                if every is None:
                    self._send_once(frames, gap=0.0)
                else:
                    self.cycles.begin(kind, Source.of(frames, every))
                self._last[kind] = frames[-1]
            self._changed.notify_all()

    def supply(self, kind: type[Message], make: Maker, period: float | None) -> None:
        """See `Node.supply`."""
        self.check_open()
        self._check(kind)
        _check_period(period)
        with self._changed:
            self.cycles.begin(kind, Source(make, period or kind.PERIOD))
            self._changed.notify_all()

    def provide(self, messages: Iterable[Message]) -> None:
        """See `Node.provide`."""
        self.check_open()
        for kind, frames in self._checked(messages).items():
            self._provide(kind, Source.of(frames, kind.PERIOD))

    def provide_from(self, kind: type[Message], make: Maker) -> None:
        """See `Node.provide_from`."""
        self.check_open()
        self._check(kind)
        self._provide(kind, Source(make, kind.PERIOD))

    def clear(self, kinds: Iterable[type[Message]]) -> None:
        """See `Node.clear`."""
        gone = frozenset(kinds)
        with self._changed:
            for kind in gone:
                self.cycles.end(kind)
                self._answers.pop(kind, None)
            self._once = [entry for entry in self._once if type(entry[2]) not in gone]
            heapq.heapify(self._once)

    def send(self, message: Message) -> None:
        """See `Node.send`."""
        self.check_open()
        self._check(type(message))
        self._transmitter.send(message)
        self._last[type(message)] = message

    def postpone(self, kind: type[Message], seconds: float) -> None:
        """See `Node.postpone`."""
        with self._changed:
            self.cycles.postpone(kind, seconds)
            self._changed.notify_all()

    def last(self, kind: type[Message]) -> Message | None:
        """The message of a kind that was set or sent last."""
        return self._last.get(kind)

    def ask(self, kind: type[Message]) -> None:
        """Another node asks for a message: answer if that is provided."""
        with self._changed:
            self._asked.add(kind)
            answer = self._answers.get(kind)
        if answer is None:
            return
        if answer.period is None:
            self._answer_once(kind, answer)
            return
        with self._changed:
            self.cycles.begin(kind, answer)
            self._changed.notify_all()

    def withdraw(self, kind: type[Message]) -> None:
        """Another node asks for a message no more."""
        with self._changed:
            self._asked.discard(kind)
            if kind in self._answers:
                self.cycles.end(kind)

    def run(self) -> None:
        """Send all that is due."""
        while self.send_next():
            pass

    def send_next(self) -> bool:
        """Send one frame that is due; False where none is."""
        return self._send_due_once() or self.cycles.send_next()

    def run_once_only(self) -> None:
        """Send what is due and not cyclic."""
        while self._send_due_once():
            pass

    def wait(self, life: Life, at_most: float) -> None:
        """Wait until something is due or something changes, so many seconds at most."""
        with self._changed:
            left = self.next_due - self._clock.now()
            if left > 0 and not life.is_over:
                self._changed.wait(min(left, at_most))

    def wake(self) -> None:
        """Let `wait` return, unless somebody who hangs holds everything up."""
        if self._changed.acquire(timeout=_AT_MOST):
            self._changed.notify_all()
            self._changed.release()

    def _checked(self, messages: Iterable[Message]) -> Mapping[type[Message], tuple[Message, ...]]:
        """Messages by kind, once all of them have proved fit to be sent."""
        by_kind: dict[type[Message], tuple[Message, ...]] = {}
        for message in messages:
            self._check(type(message))
            self._transmitter.check(message)
            by_kind[type(message)] = (*by_kind.get(type(message), ()), message)
        return by_kind

    def check_open(self) -> None:
        """Raise `SendingError` where nothing is taken any more."""
        if self.closed:
            raise SendingError(self.closed)

    def _check(self, kind: type[Message]) -> None:
        if kind not in self._may_send:
            who = " or ".join(kind.MODEL.senders) or "nobody"
            raise SendingError(f"{self._name} does not send {kind.NAME}: {who} does")

    def _provide(self, kind: type[Message], answer: Source) -> None:
        with self._changed:
            self._answers[kind] = answer
            wanted = kind in self._asked
        if wanted and answer.period is not None:
            self.ask(kind)

    def _answer_once(self, kind: type[Message], answer: Source) -> None:
        """Send an answer unless the one to the request before is still on its way."""
        with self._changed:
            if any(type(message) is kind for *_, message in self._once):
                return
        frames = frames_of(kind, answer.make, self._transmitter)
        with self._changed:
            self._send_once(frames, gap=_ANSWER_GAP)
            self._changed.notify_all()

    def _send_once(self, messages: Sequence[Message], *, gap: float) -> None:
        now = self._clock.now()
        for place, message in enumerate(messages):
            heapq.heappush(self._once, (now + place * gap, next(self._number), message))

    def _send_due_once(self) -> bool:
        with self._changed:
            if not self._once or self._once[0][0] > self._clock.now():
                return False
            message = heapq.heappop(self._once)[2]
        self._transmitter.try_to_send(message)
        return True


def _check_period(period: float | None) -> None:
    if period is not None and not 0 < period < math.inf:
        raise SendingError(f"a period is a positive number of seconds, not {period}")
