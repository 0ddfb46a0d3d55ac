"""What makes a node live: its parts put together, and what turns them, in threads or by hand."""

from __future__ import annotations

import atexit
import logging
import math
import threading
from collections import defaultdict, deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Literal

import can

from swapcan.node.events import (
    BusBack,
    BusLost,
    Dispatcher,
    NodeFailed,
    ReceiveFailed,
    SendFailed,
)
from swapcan.node.inbox import Hearer, Inbox
from swapcan.node.leaving import leave_safe
from swapcan.node.outbox import Outbox
from swapcan.node.port import Port
from swapcan.node.request import Requests
from swapcan.node.transmit import Transmitter
from swapcan.process_signals import LAST_WORDS
from swapcan.wire import Codec
from typedcan.model.errors import TypedcanError
from typedcan.supervise import Supervisor
from typedcan.wire.acting import acting_fields
from typedcan.wire.clock import Clock
from typedcan.wire.errors import StillActingError, one_line
from typedcan.wire.link import Received
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol, Request

Leave = Literal["safe", "silent"]
"""How a node is left: with the safe codes of what acts, or without a word."""

_LOG = logging.getLogger("swapcan")

_WAIT = 0.1
"""Seconds in one call of the bus: as long as a node takes to stop, and to notice a new request."""

_HANGING = 0.5
"""Seconds after which a receiver counts as hanging, and the sender lets time pass in its stead."""

_PATIENCE = 3.0
"""Seconds to wait for a thread to end; one that hangs in a driver never does."""


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
        leave: Leave,
    ) -> None:
        self._name = name
        self._leaves_safe = leave == "safe" and any(map(acting_fields, protocol.sent_by(name)))
        self._still_acting: StillActingError | None = None
        self._clock = clock
        # Noticed in any thread, told in the one that receives.
        self._notices: deque[BusLost | BusBack | SendFailed | ReceiveFailed] = deque()
        self.dispatcher = Dispatcher()
        self._port = Port(bus, clock, self._notices.append, reopen=reopen)
        self._transmitter = Transmitter(self._port, codec, clock, self._notices.append)
        self.outbox = Outbox(protocol, name, self._transmitter, self._port, clock)
        self._port.on_new_bus = self.outbox.cycles.take_all_back
        self.requests = Requests(protocol, self._say, self.outbox.last)
        self.inbox = Inbox(
            protocol, name, codec, supervisor, self.dispatcher, self._hearers(protocol)
        )
        self.inbox.start(clock.now())
        self._stopping = threading.Event()
        self._threads: tuple[threading.Thread, ...] = ()
        self._came_round = clock.now()  # when the one that receives was last done with a frame
        self._frames_fail = False

    @property
    def next_due(self) -> float:
        """When `turn` has something to do if nothing arrives; `math.inf` for never."""
        return min(self.outbox.next_due, self._next_check())

    def turn(self) -> None:
        """Take what has arrived, let time pass up to the clock's, and send what is due."""
        if self._threads:
            raise TypedcanError(f"{self._name} has been started: its threads turn it")
        while frame := self._port.receive(0):
            self._take(frame, self._clock.now())
        self._check(self._clock.now())
        self.outbox.run()
        self._tell_notices()

    def start(self) -> None:
        """Begin to send and to receive, in two threads."""
        if self._threads:
            raise TypedcanError(f"{self._name} has been started already")
        # A new one each time: a thread that stopped its node may not have ended yet.
        self._stopping = stopping = threading.Event()
        self._notices.clear()
        self._still_acting = None
        self.outbox.closed = ""
        now = self._clock.now()
        self._came_round = now
        self.inbox.start(now)
        self.outbox.cycles.start(use_timers=True)
        self._threads = tuple(
            threading.Thread(
                target=self._guard,
                args=(loop, stopping),
                name=f"swapcan-{self._name}-{what}",
                daemon=True,
            )
            for what, loop in (("send", self._send_loop), ("receive", self._receive_loop))
        )
        atexit.register(self._stop_at_exit)
        if self._leaves_safe:
            LAST_WORDS.add(self._speak_last)
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
        """End all that was begun; does nothing where that is done.

        Raises `StillActingError` where what acts could not be ended.
        """
        started = bool(self._threads)
        self.ask_to_stop()
        if not started:
            self._leave(once=True)
        for thread in self._threads:  # the one that sends is the first: it sends the safe codes
            if thread is not threading.current_thread():  # a callback may stop its node
                thread.join(_PATIENCE)
        self._threads = ()
        self.requests.stop()
        self.outbox.run_once_only()
        self.outbox.cycles.stop()
        if started:
            self.outbox.closed = f"{self._name} has been stopped, it sends nothing more"
        atexit.unregister(self._stop_at_exit)
        LAST_WORDS.discard(self._speak_last)
        self._port.close()
        self.dispatcher.end_streams()
        still_acting, self._still_acting = self._still_acting, None
        if still_acting:
            raise still_acting

    @property
    def acting(self) -> tuple[Message, ...]:
        """See `Transmitter.acting`."""
        return self._transmitter.acting

    def send_safe_codes(self) -> Exception | None:
        """See `Transmitter.send_safe_codes`."""
        return self._transmitter.send_safe_codes()

    def _guard(self, loop: Callable[[threading.Event], None], stopping: threading.Event) -> None:
        """Live in a thread; where that cannot go on, the node ends, and says so."""
        try:
            loop(stopping)
        except BaseException as error:  # noqa: BLE001 - no thread ends without a word
            _LOG.exception("a thread of %s cannot go on", self._name)
            self.outbox.closed = f"{self._name} sends nothing more: {one_line(error)}"
            stopping.set()
            self.outbox.wake()
            self.dispatcher.emit(NodeFailed(one_line(error), self._clock.now()))

    def _send_loop(self, stopping: threading.Event) -> None:
        try:
            while not stopping.is_set():
                self.outbox.run()
                self._stand_in()
                self.outbox.wait(stopping, _HANGING)
        finally:
            self._leave()

    def _stand_in(self) -> None:
        """Let time pass for a receiver that does not come back from the bus, or from a callback."""
        now = self._clock.now()
        if now - self._came_round >= _HANGING:
            self._check(now)
            self._tell_notices()

    def _receive_loop(self, stopping: threading.Event) -> None:
        # What is done for every frame is kept short; what else is due is looked for now and then.
        receive, take, clock = self._port.receive, self._take, self._clock.now
        now = due = clock()
        while not stopping.is_set():
            frame = receive(due - now if due > now else 0)
            now = self._came_round = clock()
            changed = frame is not None and take(frame, now)
            if changed or frame is None or now >= due:
                self._check(now)
                self._tell_notices()
                due = min(self._next_check(), now + _WAIT)
                if self._port.retry_at < math.inf:  # until then receiving returns at once
                    stopping.wait(max(due - now, 0))

    def _take(self, frame: can.Message, now: float) -> bool:
        """Take a frame; True where that may change when there is something to do."""
        try:
            changed = self.inbox.take(frame, now)
        except Exception as error:  # noqa: BLE001 - such as that of a user's checksum
            if not self._frames_fail:
                _LOG.exception("a frame could not be handled; the node goes on")
                self._notices.append(ReceiveFailed(one_line(error), now))
            self._frames_fail = True
            return True
        self._frames_fail = False
        return changed

    def _leave(self, *, once: bool = False) -> None:
        if self._leaves_safe:
            self._still_acting = leave_safe(self._transmitter, once=once)

    def _speak_last(self) -> None:
        """Before a signal ends or stops the process: nothing acts any more."""
        self.outbox.closed = f"{self._name} has been stopped by a signal, it sends nothing more"
        self._transmitter.send_safe_codes()
        self.ask_to_stop()
        for thread in self._threads[:1]:
            thread.join(_PATIENCE)
        if self._transmitter.acting:  # the thread hangs, or what the main thread holds up
            self._transmitter.send_safe_codes()

    def _stop_at_exit(self) -> None:
        """Where a program ends without stopping its node."""
        try:
            self.stop()
        except TypedcanError:
            _LOG.exception("%s was not left safe", self._name)

    def _say(self, message: Message) -> None:
        """Send a message of a request, unless nothing is sent any more."""
        if not self.outbox.closed:
            self.outbox.set([message], None)

    def _next_check(self) -> float:
        return min(self.inbox.next_check, self.requests.next_check, self._port.retry_at)

    def _check(self, now: float) -> None:
        if now >= self.inbox.next_check:
            self.inbox.check(now)
        if now >= self.requests.next_check:
            self.requests.check(now)

    def _tell_notices(self) -> None:
        with suppress(IndexError):  # another thread may have told the last one
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
