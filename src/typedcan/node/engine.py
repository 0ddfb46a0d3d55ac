"""What makes a node live: its parts put together, and what turns them, in threads or by hand."""

from __future__ import annotations

import atexit
import logging
import threading
import time
from collections import defaultdict, deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Literal

import can

from typedcan.model.errors import TypedcanError, one_line
from typedcan.model.j1939 import sent_identifier
from typedcan.node.clock import Clock
from typedcan.node.errors import StillActingError
from typedcan.node.events import Dispatcher, NodeFailed
from typedcan.node.inbox import Hearer, Inbox
from typedcan.node.leaving import Leaving
from typedcan.node.life import Life, wait_for
from typedcan.node.outbox import Outbox
from typedcan.node.port import Port
from typedcan.node.reception import Notice, Reception
from typedcan.node.request import RequestHearer, Requests
from typedcan.node.transmit import Sends, Transmitter
from typedcan.shell.process_signals import LAST_WORDS
from typedcan.supervise import Supervisor
from typedcan.transfer import Transfers
from typedcan.wire.acting import acting_fields
from typedcan.wire.codec import Codec
from typedcan.wire.errors import SendingError
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

Leave = Literal["safe", "silent"]
"""How a node is left: with the safe codes of what acts, or without a word."""

_LOG = logging.getLogger("typedcan")

_LOOK = 0.1
"""Seconds after which the thread that sends looks whether the one that receives hangs."""

_PATIENCE = 3.0
"""Seconds to wait for the threads to end; one that hangs in a driver never does."""

_LEAST = 0.1
"""Seconds for each of them, also after one that hangs."""


class Engine:
    """The parts of one node, and their life.

    In threads there are two, whatever the node sends: one sends what is due, the other takes what
    arrives, and calls back. While that one hangs a third lets time pass in its stead. By hand,
    `turn` does the work of all.
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
        transfers: Transfers,
        source_address: int,
    ) -> None:
        self._name = name
        self._clock = clock
        notices: deque[Notice] = deque()
        self.dispatcher = Dispatcher()
        self._port = Port(bus, clock, notices.append, reopen=reopen)
        self._transmitter = Transmitter(self._port, codec, clock, notices.append, source_address)
        self.outbox = Outbox(protocol, name, self._transmitter, self._port, clock)
        self._port.on_new_bus = self.outbox.cycles.take_all_back
        self.requests = Requests(protocol, self._say, self.outbox.last)
        hearers, sends = self._hearers(protocol), protocol.sent_by(name)
        own = {(sent_identifier(kind.MODEL, source_address), kind.EXTENDED) for kind in sends}
        self.inbox = Inbox(own, codec, supervisor, self.dispatcher, hearers, transfers)
        self._reception = Reception(
            self._port, self.inbox, self.requests, self.dispatcher, notices, clock
        )
        self._reception.start()
        self._leaves_safe = leave == "safe" and any(map(acting_fields, sends))
        self._leaving = Leaving(self._transmitter, self._port, safe=self._leaves_safe)
        self.patience = _PATIENCE
        self._life = Life()
        self._sender: threading.Thread | None = None
        self._threads: tuple[threading.Thread, ...] = ()

    @property
    def next_due(self) -> float:
        """When `turn` has something to do if nothing arrives; `math.inf` for never."""
        return min(self.outbox.next_due, self._reception.next_check)

    def turn(self) -> None:
        """Take what has arrived, let time pass up to the clock's, and send what is due."""
        if self._threads:
            raise TypedcanError(f"{self._name} has been started: its threads turn it")
        self._reception.turn()
        self.outbox.run()
        self._reception.tell_notices()

    def start(self) -> None:
        """Begin to send and to receive, in two threads."""
        if self._threads:
            raise TypedcanError(f"{self._name} has been started already")
        wait_for(self._sender, self.patience)
        if self._sender and self._sender.is_alive():
            raise TypedcanError(f"{self._name} cannot be started: a thread of it still hangs")
        # A new one each time: a thread that stopped its node may not have ended yet.
        self._life = life = Life()
        self._leaving.start()
        self.outbox.closed = ""
        self._reception.start()
        self.outbox.cycles.start(use_timers=True)
        self._sender = self._thread("send", self._send_loop, life)
        self._threads = (self._sender, self._thread("receive", self._reception.run, life))
        atexit.register(self._stop_at_exit)
        if self._leaves_safe:
            LAST_WORDS.add(self)
        try:
            for thread in self._threads:
                thread.start()
        except BaseException:  # else one would live on, and nobody end it
            self.stop()
            raise

    def ask_to_stop(self) -> None:
        """Let the threads end; returns at once."""
        if self._threads:
            self._end(self._life, f"{self._name} has been stopped, it sends nothing more")

    @property
    def runs(self) -> bool:
        """Whether a thread has not ended yet."""
        return any(thread.is_alive() for thread in self._threads)

    def stop(self, patience: float | None = None) -> None:
        """End all that was begun; does nothing where that is done.

        Waits for the threads for ``patience`` seconds. Raises `StillActingError` where what acts
        could not be ended.
        """
        try:
            if self._threads:
                self._stop(self.patience if patience is None else patience)
            else:
                self._stop_by_hand()
        except BaseException:  # such as a second Ctrl-C: the threads end by themselves
            self.ask_to_stop()
            raise
        if self._leaving.failure:
            raise self._leaving.failure

    @property
    def acting(self) -> tuple[Message, ...]:
        """See `Transmitter.acting`."""
        return self._transmitter.acting

    @property
    def sends(self) -> Sends:
        """See `Transmitter.sends`."""
        return self._transmitter.sends

    @sends.setter
    def sends(self, sends: Sends) -> None:
        self._transmitter.sends = sends

    def send_safe_codes(self) -> Exception | None:
        """See `Transmitter.send_safe_codes`."""
        return self._transmitter.send_safe_codes()

    def speak_last(self) -> None:
        """Before a signal ends or stops the process: nothing acts any more."""
        self._leaving.begin()
        why = f"{self._name} has been stopped by a signal, it sends nothing more"
        self.outbox.closed = self.outbox.closed or why
        self._leaving.leave()
        self._life.is_over = True

    def go_on(self) -> None:
        """After a signal that only stopped the process: what it interrupted sends nothing."""
        if self._transmitter.is_sending_here:
            raise SendingError(self.outbox.closed)

    def _stop(self, patience: float) -> None:
        """End the threads, or leave one that hangs, and what is left to do after them."""
        self.ask_to_stop()
        is_sender = self._sender is threading.current_thread()
        if not self._leaving.is_elsewhere:
            if is_sender:  # what makes a message may stop its node
                self._leaving.leave()
            end = time.monotonic() + patience
            for thread in (*self._threads, self._life.stand_in):  # the sender is the first
                wait_for(thread, max(end - time.monotonic(), _LEAST))
            if self._sender and self._sender.is_alive() and not is_sender:
                self._life.failed = True  # it may hold what would be needed to send
                self._leaving.leave_beside()
            self._finish()
        self._threads = ()
        atexit.unregister(self._stop_at_exit)
        LAST_WORDS.discard(self)

    def _stop_by_hand(self) -> None:
        sends = self._transmitter.sends
        self._leaving.begin()
        try:
            self._leaving.leave(once=True)
            self._finish()
        finally:
            self._transmitter.sends = sends

    def _finish(self) -> None:
        """What is left to do where nothing acts any more."""
        self.requests.stop()
        if not self._life.failed:
            self.outbox.run_once_only()
            self.outbox.cycles.stop()
        self._leaving.end()
        with suppress(Exception):  # a bus that is gone need not be closed
            self._port.close()
        self.dispatcher.end_streams()

    def _thread(self, what: str, loop: Callable[[Life], None], life: Life) -> threading.Thread:
        name = f"typedcan-{self._name}-{what}"
        return threading.Thread(target=self._live, args=(loop, life), name=name, daemon=True)

    def _live(self, loop: Callable[[Life], None], life: Life) -> None:
        """Live in a thread; where that cannot go on, the node ends, and says so."""
        failure: BaseException | None = None
        try:
            loop(life)
        except BaseException as error:  # noqa: BLE001 - no thread ends without a word
            failure = error
            life.failed = True
            self._end(life, f"{self._name} sends nothing more: {one_line(error)}")
        if loop == self._send_loop:
            self._leaving.leave()
            self.outbox.cycles.stop()
        if failure:
            with suppress(BaseException):  # of those who are told
                self.dispatcher.emit(NodeFailed(one_line(failure), self._clock.now()))
            self.requests.stop()
            _LOG.error("a thread of %s cannot go on", self._name, exc_info=failure)

    def _send_loop(self, life: Life) -> None:
        while not life.is_over:
            if self._reception.hangs and not (life.stand_in and life.stand_in.is_alive()):
                self._stand_in(life)
            if not self.outbox.send_next():
                self.outbox.wait(life, _LOOK)

    def _stand_in(self, life: Life) -> None:
        """Let time pass for a receiver that hangs, in a thread: a callback may hang there too."""
        life.stand_in = self._thread("stand-in", self._reception.stand_in, life)
        try:
            life.stand_in.start()
        except RuntimeError:  # no thread can be started any more
            self._reception.let_time_pass()

    def _end(self, life: Life, why: str) -> None:
        """Let a life end; the first reason counts."""
        life.is_over = True
        if life is self._life:
            self._leaving.begin()
            if life.failed:
                self._leaving.end()
            self.outbox.closed = self.outbox.closed or why
            self.outbox.wake()

    def _stop_at_exit(self) -> None:
        """Where a program ends without stopping its node."""
        try:
            self.stop()
        except StillActingError as error:
            _LOG.error("%s: %s", self._name, error)

    def _say(self, message: Message) -> None:
        """Send a message of a request, unless the node cannot."""
        if not self._life.failed:
            self.outbox.put([message], None)

    def _hearers(self, protocol: Protocol) -> Mapping[type[Message], Sequence[Hearer]]:
        """What requests have to do with which message."""
        hearers: defaultdict[type[Message], list[Hearer]] = defaultdict(list)
        ask, withdraw = self.outbox.ask, self.outbox.withdraw
        for request in protocol.requests:
            hearers[request.field.message].append(RequestHearer(request, ask, withdraw))
            for answer in request.answers:
                hearers[answer].append(self.requests.hear)
        return dict(hearers)
