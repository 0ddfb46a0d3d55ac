"""Supervision of what a node receives: which messages come, how regularly, with which faults.

Nothing here has a thread, reads a clock or waits: times are handed in, in seconds of one clock
that never goes back. It is not locked either.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from operator import itemgetter

from typedcan.supervise.events import State, SupervisionEvent
from typedcan.supervise.snapshot import Snapshot
from typedcan.supervise.tracked_message import TrackedMessage
from typedcan.wire.errors import UnknownMessageError
from typedcan.wire.link import Fault, Received
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_NOTHING: tuple[SupervisionEvent, ...] = ()


class Supervisor:
    """Watches the messages that a node receives.

    A message is late after ``late_periods`` of silence and lost after ``timeout_periods``, and
    alive with its next frame. Only expected messages are ever late or lost. The others that come
    are measured and checked all the same.

    Parameters
    ----------
    protocol, node
        Whose messages, and the node that receives them; None for all of them, as a monitor does.
    expect
        The messages that have to come; without it those for the node that have a period at all
        times.
    timeout_periods, late_periods
        In expected periods, greater than 0.
    timeouts
        Seconds after which an expected message is lost, for some messages.
    timestamps
        Whether the time between frames is measured by their timestamps. False measures it by the
        clock: where that is simulated, timestamps have another time.

    Raises `UnknownNodeError`, `UnknownMessageError` and `ValueError`.
    """

    def __init__(
        self,
        protocol: Protocol,
        node: str | None,
        *,
        expect: Iterable[type[Message]] | None = None,
        timeout_periods: float = 5.0,
        late_periods: float = 1.5,
        timeouts: Mapping[type[Message], float] | None = None,
        timestamps: bool = True,
    ) -> None:
        self._node = node or ""
        meant = protocol.messages if node is None else protocol.received_by(node)
        self._meant = frozenset(meant)
        self._timeout_periods = _positive(timeout_periods, "timeout_periods")
        self._late_periods = _positive(late_periods, "late_periods")
        self._timestamps = timestamps
        self._tracked = {kind: TrackedMessage(kind, protocol) for kind in protocol.messages}
        self._by_name = {kind.NAME: tracked for kind, tracked in self._tracked.items()}
        self._timeouts = dict(timeouts or {})
        for kind, seconds in self._timeouts.items():
            _positive(seconds, f"the timeout of {self._known(kind).kind.NAME}")
        if expect is None:
            always = self._meant.difference(protocol.conditional)
            expect = [kind for kind in always if kind.PERIOD is not None]
        for kind in expect:
            self._expect(self._known(kind), kind.PERIOD)
        self._next = math.inf

    @property
    def next_check(self) -> float:
        """When `check` is due: no later than time alone changes something, infinite for never."""
        return self._next

    def start(self, now: float) -> None:
        """Wait for the expected messages from now on; silence before does not count."""
        for tracked in self._tracked.values():
            tracked.wait_from(now)
        self._next = self._first_deadline()

    def expect_period(
        self, message: type[Message], seconds: float | None, *, now: float | None = None
    ) -> None:
        """Expect a message with this period, whatever the standard has; None: no longer expect it.

        Pass ``now`` once supervision has begun: silence before does not count. Raises
        `UnknownMessageError` and `ValueError`.
        """
        tracked = self._known(message)
        if seconds is None:
            tracked.expected = False
            tracked.late = tracked.timeout = math.inf
            tracked.period = message.PERIOD
            return
        self._expect(tracked, _positive(seconds, f"the period of {message.NAME}"))
        if now is not None:
            tracked.wait_from(now)
        self._next = min(self._next, tracked.deadline)

    def take(self, received: Received[Message], now: float) -> tuple[SupervisionEvent, ...]:
        """What a message changes that came in; its faults are counted."""
        tracked = self._tracked.get(received.kind)
        if tracked is None:
            return _NOTHING
        stamp = received.frame.timestamp if self._timestamps else now
        events = tracked.take(received, now, stamp)
        if events:
            self._next = min(self._next, tracked.deadline)
        return events

    def fault(self, fault: Fault, now: float) -> tuple[SupervisionEvent, ...]:  # noqa: ARG002
        """Count a frame that was refused; it does not keep its message alive.

        The faults of a `Received` are counted by `take`, not here.
        """
        tracked = self._by_name.get(fault.message)
        if tracked:
            tracked.count(fault)
        return _NOTHING

    def check(self, now: float) -> tuple[SupervisionEvent, ...]:
        """What time alone has changed up to now, in the order in which it did."""
        if now < self._next:
            return _NOTHING
        due = [(tracked.deadline, tracked) for tracked in self._tracked.values()]
        due = sorted((one for one in due if one[0] <= now), key=itemgetter(0))
        events = tuple(tracked.overdue(now) for _, tracked in due)
        self._next = self._first_deadline()
        return events

    def state(self, message: type[Message]) -> State:
        """The state of a message, as of the last call; raises `UnknownMessageError`."""
        return self._known(message).state

    def snapshot(self, now: float) -> Snapshot:
        """All that is known, as plain data."""
        messages = tuple(
            tracked.snapshot(now)
            for kind, tracked in self._tracked.items()
            if kind in self._meant
            or tracked.expected
            or tracked.frames
            or any(tracked.faults.values())
        )
        return Snapshot(self._node, now, messages)

    def _known(self, message: type[Message]) -> TrackedMessage:
        tracked = self._tracked.get(message)
        if tracked is None:
            raise UnknownMessageError(f"{message.__name__} is no message of this protocol")
        return tracked

    def _first_deadline(self) -> float:
        return min((tracked.deadline for tracked in self._tracked.values()), default=math.inf)

    def _expect(self, tracked: TrackedMessage, period: float | None) -> None:
        tracked.expected = True
        tracked.period = period
        tracked.late = math.inf if period is None else period * self._late_periods
        timeout = math.inf if period is None else period * self._timeout_periods
        tracked.timeout = self._timeouts.get(tracked.kind, timeout)


def _positive(seconds: float, what: str) -> float:
    if not seconds > 0:
        raise ValueError(f"{what} is {seconds:g}, it must be greater than 0")
    return seconds
