"""A live node: sends what the standard asks for when it asks for it, and watches the others."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Callable, Iterable, Mapping
from typing import Any, TypeVar, overload

import can

from typedcan.model.j1939 import address_in
from typedcan.node.answers import Collector, MessageCollector, TransferCollector, heard
from typedcan.node.clock import Clock, SystemClock
from typedcan.node.cycles import Maker
from typedcan.node.engine import Engine, Leave
from typedcan.node.errors import RequestError
from typedcan.node.request import Pending
from typedcan.node.running import Running
from typedcan.spoken.codec import words_of
from typedcan.supervise import State, Supervisor
from typedcan.supervise.snapshot import Snapshot
from typedcan.transfer import Transfers
from typedcan.wire.codec import Codec
from typedcan.wire.link import Counts, Received
from typedcan.wire.message import Message, MessageT
from typedcan.wire.protocol import Protocol

EventT = TypeVar("EventT")
AnswerT = TypeVar("AnswerT")


class Node(Running):
    """One node of a protocol on a bus of python-can, live.

    Use it in ``with`` or ``async with``, or `start` and `stop` it: two threads then send what is
    due and take what arrives, whatever the number of messages. Or drive it by hand, with `turn`,
    on a clock of one's own. Leaving stops what the node started and nothing else.

    Callbacks run one after another in the thread that receives; while that hangs, in the bus or in
    a callback, what time alone changes is told by a third. The interface of the bus must let one
    thread send while another receives, as most do; `can.ThreadSafeBus` helps those that do not.

    Whatever exception a bus raises is trouble that is reported, and tried again. A node that cannot
    go on, since a bus or a callback raised `SystemExit` for example, tells it as `NodeFailed`, ends
    what acts and sends no more. So it does where a signal ends or stops the process, SIGTERM or
    Ctrl-Z for example, if it was started in the main thread and the program leaves that signal
    alone, and where the program ends without stopping it.

    Parameters
    ----------
    protocol
        What its nodes send and receive.
    name
        Which of its nodes; raises `UnknownNodeError`.
    bus
        Is lent: it is never closed here.
    codec
        For checksum algorithms of one's own, or to speak an edition: a `SpokenCodec`.
    clock
        What the time is; the system's clock if none is given.
    expect, timeout_periods, late_periods, timeouts
        See `Supervisor`.
    reopen
        Opens another bus where the one at hand does not work any more. What it opened, the node
        closes.
    leave
        What happens in the end where the node has commanded something that acts, such as high
        voltage on: "safe" sends the safe codes first, as long as the bus takes them; "silent", for
        tests of how others take it, just ends.
    transfers
        What puts values of several frames together; those of the protocol's transfers if none is
        given.
    source_address
        The J1939 address to send from, where the database leaves it open (0xFE); without it, that
        of the node.
    """

    def __init__(
        self,
        protocol: Protocol,
        name: str,
        bus: can.BusABC,
        *,
        codec: Codec | None = None,
        clock: Clock | None = None,
        expect: Iterable[type[Message]] | None = None,
        timeout_periods: float = 5.0,
        late_periods: float = 1.5,
        timeouts: Mapping[type[Message], float] | None = None,
        reopen: Callable[[], can.BusABC] | None = None,
        leave: Leave = "safe",
        transfers: Transfers | None = None,
        source_address: int | None = None,
    ) -> None:
        self.protocol = protocol
        self.name = name
        self.clock: Clock = clock or SystemClock()
        codec = codec or Codec(protocol)
        self._words = words_of(codec)
        if codec.bare is not codec:  # all within goes by what is on the bus
            codec, protocol = codec.bare, codec.protocol
        self._requests = protocol.requests
        kind = self._words.kind
        supervisor = Supervisor(
            protocol,
            name,
            expect=None if expect is None else [*map(kind, expect)],
            timeout_periods=timeout_periods,
            late_periods=late_periods,
            timeouts={kind(each): seconds for each, seconds in (timeouts or {}).items()},
            # Frames have the system's time, which means nothing to any other clock.
            timestamps=isinstance(self.clock, SystemClock),
        )
        self._transfers = transfers or Transfers(protocol)
        own = address_in(protocol.model, name)
        self._engine = Engine(
            protocol,
            name,
            bus,
            codec=codec,
            clock=self.clock,
            supervisor=supervisor,
            reopen=reopen,
            leave=leave,
            transfers=self._transfers,
            source_address=own if source_address is None else source_address,
        )
        self._outbox = self._engine.outbox
        self._inbox = self._engine.inbox

    # Sending

    def set(self, *messages: Message, period: float | None = None) -> None:
        """Send messages from now on, or other values of those that are being sent.

        A message with a period, its own or ``period`` seconds, is sent cyclically; new values do
        not disturb its rhythm. Several messages of one type are the frames of one cycle, spread
        evenly over it; they change with the cycle. A message without a period goes out once.
        Checksums and alive counters are filled in at each transmission. Raises `SendingError` for
        a message that is not this node's, or once the node sends no more, and `EncodeError`; then
        nothing is set.
        """
        self._outbox.set([*map(self._words.said, messages)], period)

    def supply(self, kind: type[Message], make: Maker, *, period: float | None = None) -> None:
        """Send a message cyclically; ``make`` is asked for the frames of each cycle anew.

        It is called in the thread that sends. What it raises, or returns that cannot be sent, is
        reported as `SendFailed`.
        """
        self._outbox.supply(self._words.kind(kind), self._words.making(make), period)

    def provide(self, *messages: Message) -> None:
        """Have messages ready as answers.

        They are sent while another node's request asks for them, with their period, or once for
        each request where they have none.
        """
        self._outbox.provide([*map(self._words.said, messages)])

    def provide_from(self, kind: type[Message], make: Maker) -> None:
        """As `provide`, but ``make`` is asked for the frames anew each time."""
        self._outbox.provide_from(self._words.kind(kind), self._words.making(make))

    def clear(self, *kinds: type[Message]) -> None:
        """Send messages no more: neither in cycles, nor as answers, nor those still waiting."""
        self._outbox.clear(map(self._words.kind, kinds))

    def send(self, message: Message) -> None:
        """Send one frame, now; raises `SendingError`, `EncodeError` and what the bus raises."""
        self._outbox.send(self._words.said(message))

    def postpone(self, kind: type[Message], seconds: float) -> None:
        """Let the next frame of a cyclic message come late; those after it keep their times."""
        self._outbox.postpone(self._words.kind(kind), seconds)

    # Receiving

    @overload
    def on(
        self, kind: type[MessageT], callback: Callable[[Received[MessageT]], object]
    ) -> Callable[[], None]: ...
    @overload
    def on(
        self, kind: type[EventT], callback: Callable[[EventT], object]
    ) -> Callable[[], None]: ...
    def on(self, kind: type[Any], callback: Callable[[Any], object]) -> Callable[[], None]:
        """Call back with each `Received` of a message class, or with each event of a class.

        Event classes are `Received`, for all messages, `Fault`, those of supervision and
        transfers, `BusLost`, `BusBack`, `SendFailed`, `ReceiveFailed` and `NodeFailed`. Returns
        what takes the callback off. An exception of a callback is logged, by "typedcan", and stops
        nothing; what is no `Exception`, such as `SystemExit`, ends the node.
        """
        return self._engine.dispatcher.on(*self._words.listening(kind, callback))

    @overload
    def events(
        self, kind: type[MessageT], *, limit: int = 10_000
    ) -> AsyncGenerator[Received[MessageT], None]: ...
    @overload
    def events(
        self, kind: type[EventT], *, limit: int = 10_000
    ) -> AsyncGenerator[EventT, None]: ...
    @overload
    def events(self, *, limit: int = 10_000) -> AsyncGenerator[Any, None]: ...
    def events(
        self, kind: type[Any] | None = None, *, limit: int = 10_000
    ) -> AsyncGenerator[Any, None]:
        """Events from now on, for ``async for``, until the node is stopped.

        All of them, or each `Received` of a message class, or each event of a class, as `on` has
        them. At most ``limit`` wait for a slow reader; then the oldest are dropped, and an
        `Overrun` says how many, or a warning of the log where only one class is asked for. Must be
        called on an event loop.
        """
        stream = self._engine.dispatcher.stream(limit, self._words.wanted(kind))
        return self._words.stream(stream)

    def last(self, kind: type[MessageT]) -> Received[MessageT] | None:
        """The message of a kind that came last, if any."""
        received: Received[Any] | None = self._inbox.last(self._words.wanted(kind))
        return self._words.received(received) if received else None

    def state(self, kind: type[Message]) -> State:
        """How regularly a message comes in."""
        return self._inbox.state(self._words.wanted(kind))

    def snapshot(self) -> Snapshot:
        """What supervision knows at this moment."""
        return self._inbox.snapshot(self.clock.now())

    def missing(self, transfer: str) -> str:
        """What a transfer, such as "cell_voltages", lacks to be complete; for people."""
        return self._inbox.missing(transfer)

    @property
    def counts(self) -> Counts:
        """How many frames came in and what became of them."""
        return self._inbox.counts

    # Requests

    @overload
    def request(
        self, what: type[MessageT], *, timeout: float = 5.0, again: float = 1.0
    ) -> Pending[MessageT]: ...
    @overload
    def request(
        self, what: str, kind: type[AnswerT], *, timeout: float = 5.0, again: float = 1.0
    ) -> Pending[AnswerT]: ...
    @overload
    def request(self, what: str, *, timeout: float = 5.0, again: float = 1.0) -> Pending[Any]: ...
    def request(
        self,
        what: type[Message] | str,
        kind: type[Any] | None = None,
        *,
        timeout: float = 5.0,
        again: float = 1.0,
    ) -> Pending[Any]:
        """Ask for a message, or for the transfer of a name, such as ``request("serial", Text)``.

        The answer is the message, or the value of the transfer, of which ``kind`` is the class.
        The request is repeated every ``again`` seconds until it is answered, and withdrawn then,
        after ``timeout`` seconds, or when it is cancelled. Other fields of the message that asks
        stay as they were last. Raises `RequestError` where this node has no such request, has it
        under way, or the transfer is no ``kind``; `LookupError` for a name that there is not, and
        `TransferError` for a transfer that cannot be put together.
        """
        if not isinstance(what, str):
            return self.ask(what.NAME, what, MessageCollector(what), timeout, again)
        assembler = self._transfers.assembler(what)
        result = self._transfers.result_of(what)
        if kind is not None and not issubclass(result, kind):
            raise RequestError(f"{what} is {result.__name__}, not {kind.__name__}")
        collector: Collector[Any] = TransferCollector(assembler)
        return self.ask(what, assembler.transfer.messages[0], collector, timeout, again)

    def ask(
        self,
        name: str,
        answer: type[Message],
        collector: Collector[AnswerT],
        timeout: float = 5.0,
        again: float = 1.0,
    ) -> Pending[AnswerT]:
        """As `request`, but ``collector`` puts the answer together, whatever it is.

        ``answer`` is a message of it, and ``name`` what it is for people.
        """
        self._outbox.check_open()
        answer, collector = self._words.kind(answer), heard(collector, self._words)
        for request in self._requests:
            if answer in request.answers and self.name in request.field.message.MODEL.senders:
                return self._engine.requests.begin(
                    name, request, collector, timeout=timeout, again=again, now=self.clock.now()
                )
        raise RequestError(f"{self.name} has no request for the {name}")
