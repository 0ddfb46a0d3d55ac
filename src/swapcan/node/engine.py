"""What makes a node live: its parts put together, and what turns them, in threads or by hand."""

from __future__ import annotations

import math
import threading
from collections import defaultdict, deque
from collections.abc import Callable, Mapping, Sequence

import can

from swapcan.bus import Received
from swapcan.clock import Clock
from swapcan.codec import Codec
from swapcan.errors import SwapcanError
from swapcan.message import Message
from swapcan.node.events import BusBack, BusLost, Dispatcher, SendFailed
from swapcan.node.inbox import Hearer, Inbox
from swapcan.node.outbox import Outbox
from swapcan.node.port import Port
from swapcan.node.request import Requests
from swapcan.node.transmit import Transmitter
from swapcan.protocol import Protocol, Request
from swapcan.supervise import Supervisor

_WAIT = 0.1
"""Seconds in one call of the bus: as long as a node takes to stop, and to notice a new request."""


class Engine:
    """The parts of one node, and their life.

    In threads there are two, whatever the node sends: one sends what is due, the other takes what
    arrives, and calls back. By hand, `turn` does the work of both.
    """

    def __init__(
        self,
        protocol: Protocol,
        name: str,
        bus: can.BusABC,
        *,
        codec: Codec,
        clock: Clock,
        supervisor: Supervisor,
        reopen: Callable[[], can.BusABC] | None,
    ) -> None:
        self._name = name
        self._clock = clock
        # Noticed in any thread, told in the one that receives.
        self._notices: deque[BusLost | BusBack | SendFailed] = deque()
        self.dispatcher = Dispatcher()
        self._port = Port(bus, clock, self._notices.append, reopen=reopen)
        transmitter = Transmitter(self._port, codec, clock, self._notices.append)
        self.outbox = Outbox(protocol, name, transmitter, self._port, clock)
        self._port.on_new_bus = self.outbox.cycles.take_all_back
        self.requests = Requests(
            protocol, lambda message: self.outbox.set([message], None), self.outbox.last
        )
        self.inbox = Inbox(
            protocol, name, codec, supervisor, self.dispatcher, self._hearers(protocol)
        )
        self.inbox.start(clock.now())
        self._stopping = threading.Event()
        self._threads: tuple[threading.Thread, ...] = ()

    @property
    def next_due(self) -> float:
        """When `turn` has something to do if nothing arrives; `math.inf` for never."""
        return min(self.outbox.next_due, self._next_check())

    def turn(self) -> None:
        """Take what has arrived, let time pass up to the clock's, and send what is due."""
        if self._threads:
            raise SwapcanError(f"{self._name} has been started: its threads turn it")
        while frame := self._port.receive(0):
            self.inbox.take(frame, self._clock.now())
        self._check(self._clock.now())
        self.outbox.run()
        self._tell_notices()

    def start(self) -> None:
        """Begin to send and to receive, in two threads."""
        if self._threads:
            raise SwapcanError(f"{self._name} has been started already")
        # A new one each time: a thread that stopped its node may not have ended yet.
        self._stopping = stopping = threading.Event()
        self._notices.clear()
        self.inbox.start(self._clock.now())
        self.outbox.cycles.start(use_timers=True)
        self._threads = tuple(
            threading.Thread(
                target=loop, args=(stopping,), name=f"swapcan-{self._name}-{what}", daemon=True
            )
            for what, loop in (("send", self._send_loop), ("receive", self._receive_loop))
        )
        for thread in self._threads:
            thread.start()

    def ask_to_stop(self) -> None:
        """Let the threads end; returns at once."""
        self._stopping.set()
        self.outbox.wake()

    @property
    def runs(self) -> bool:
        """Whether a thread has not ended yet."""
        return any(thread.is_alive() for thread in self._threads)

    def stop(self) -> None:
        """End all that was begun; does nothing where that is done."""
        self.ask_to_stop()
        for thread in self._threads:
            if thread is not threading.current_thread():  # a callback may stop its node
                thread.join()
        self._threads = ()
        self.requests.stop()
        self.outbox.run_once_only()
        self.outbox.cycles.stop()
        self._port.close()
        self.dispatcher.end_streams()

    def _send_loop(self, stopping: threading.Event) -> None:
        while not stopping.is_set():
            self.outbox.run()
            self.outbox.wait(stopping)

    def _receive_loop(self, stopping: threading.Event) -> None:
        # What is done for every frame is kept short; what else is due is looked for now and then.
        receive, take, clock = self._port.receive, self.inbox.take, self._clock.now
        now = due = clock()
        while not stopping.is_set():
            frame = receive(due - now if due > now else 0)
            now = clock()
            changed = frame is not None and take(frame, now)
            if changed or frame is None or now >= due:
                self._check(now)
                self._tell_notices()
                due = min(self._next_check(), now + _WAIT)
                if self._port.retry_at < math.inf:  # until then receiving returns at once
                    stopping.wait(max(due - now, 0))

    def _next_check(self) -> float:
        return min(self.inbox.next_check, self.requests.next_check, self._port.retry_at)

    def _check(self, now: float) -> None:
        if now >= self.inbox.next_check:
            self.inbox.check(now)
        if now >= self.requests.next_check:
            self.requests.check(now)

    def _tell_notices(self) -> None:
        while self._notices:
            self.dispatcher.emit(self._notices.popleft())

    def _hearers(self, protocol: Protocol) -> Mapping[type[Message], Sequence[Hearer]]:
        """What requests have to do with which message."""
        hearers: defaultdict[type[Message], list[Hearer]] = defaultdict(list)
        for request in protocol.requests:
            hearers[request.field.message].append(_RequestHearer(request, self.outbox))
            for answer in request.answers:
                hearers[answer].append(self._hear_answer)
        return dict(hearers)

    def _hear_answer(self, received: Received, now: float) -> None:
        if self.requests.next_check < math.inf:  # something is being waited for
            self.requests.take(received.message, now)


class _RequestHearer:
    """Answers what another node asks for."""

    def __init__(self, request: Request, outbox: Outbox) -> None:
        self._request = request
        self._outbox = outbox

    def __call__(self, received: Received, now: float) -> None:  # noqa: ARG002 - a Hearer
        """Take the message with the request."""
        code = getattr(received.message, self._request.field.field)
        for answer in self._request.answers:
            if code == self._request.code:
                self._outbox.ask(answer)
            elif code == self._request.withdraw:
                self._outbox.withdraw(answer)
