"""What a node does with each frame: decode it, supervise it, put transfers together, tell all."""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence

import can

from typedcan.node.events import Dispatcher
from typedcan.supervise import Supervisor
from typedcan.supervise.events import State
from typedcan.supervise.snapshot import Snapshot
from typedcan.transfer import Blocks, Readings, Text, Transfers
from typedcan.wire.codec import Codec
from typedcan.wire.link import Counts, Received
from typedcan.wire.message import Message
from typedcan.wire.receiver import Receiver

Hearer = Callable[[Received[Message], float], object]
"""Takes a message and the second at which it came."""


class Inbox:
    """Takes the frames of one bus in their order, in one thread at a time.

    Parameters
    ----------
    own
        The identifiers that the node sends, and whether they have 29 bits. Where the bus gives its
        own messages back, they are no news.
    hearers
        By message, who else takes part in it.
    transfers
        What takes several frames.
    """

    def __init__(
        self,
        own: Collection[tuple[int, bool]],
        codec: Codec,
        supervisor: Supervisor,
        dispatcher: Dispatcher,
        hearers: Mapping[type[Message], Sequence[Hearer]],
        transfers: Transfers,
    ) -> None:
        self._receiver = Receiver(codec)
        self._supervisor = supervisor
        self._emit = dispatcher.emit
        self._own = frozenset(own)
        self._transfers = transfers
        self._in_transfers = transfers.messages
        self._hearers = hearers
        self._last: dict[type[Message], Received[Message]] = {}
        self._lock = threading.Lock()

    @property
    def counts(self) -> Counts:
        """How many frames came in and what became of them."""
        return self._receiver.counts

    @property
    def next_check(self) -> float:
        """When time alone changes something; `math.inf` for never."""
        return min(self._supervisor.next_check, self._transfers.next_deadline)

    def start(self, now: float) -> None:
        """Begin to wait for messages."""
        with self._lock:
            self._supervisor.start(now)

    def take(self, frame: can.Message, now: float) -> bool:
        """Take a frame that came at ``now``; True where that may change `next_check`."""
        if (frame.arbitration_id, frame.is_extended_id) in self._own:
            return False
        taken = self._receiver.take(frame)
        if isinstance(taken, Received):
            return self._take_message(taken, now)
        if taken is None:
            return False
        with self._lock:
            events = self._supervisor.fault(taken, now)
        self._emit(taken)
        self._emit_all(events)
        return bool(events)

    def check(self, now: float) -> None:
        """Tell what changes by the passing of time."""
        with self._lock:
            events = self._supervisor.check(now)
        self._emit_all(events)
        if now >= self._transfers.next_deadline:
            with self._lock:
                problems = self._transfers.expire(now)
            self._emit_all(problems)

    def last(self, kind: type[Message]) -> Received[Message] | None:
        """The message of a kind that came last."""
        return self._last.get(kind)

    def state(self, kind: type[Message]) -> State:
        """How regularly a message comes in."""
        with self._lock:
            return self._supervisor.state(kind)

    def snapshot(self, now: float) -> Snapshot:
        """What supervision knows."""
        with self._lock:
            return self._supervisor.snapshot(now)

    def missing(self, transfer: str) -> str:
        """What a transfer lacks to be complete."""
        return self._transfers.missing(transfer)

    def _take_message(self, received: Received[Message], now: float) -> bool:
        kind = received.kind
        with self._lock:
            events = self._supervisor.take(received, now)
        self._last[kind] = received
        self._emit(received, kind)
        if received.faults:
            self._emit_all(received.faults)
        if events:
            self._emit_all(events)
        if kind in self._in_transfers:
            with self._lock:
                outcomes = self._transfers.take(received.message, now)
            for outcome in outcomes:
                self._emit(outcome, _kind_of(outcome))
        if kind in self._hearers:
            for hearer in self._hearers[kind]:
                hearer(received, now)
        return bool(events)

    def _emit_all(self, events: Iterable[object]) -> None:
        for event in events:
            self._emit(event)


def _kind_of(outcome: object) -> type | None:
    """The class of values that a result is one of, where it has a class of its own."""
    kinds = (kind for kind in (Text, Readings, Blocks) if isinstance(outcome, kind))
    kind = next(kinds, None)
    return None if kind is type(outcome) else kind
