"""One message under supervision: its state, its period, its faults."""

from __future__ import annotations

import math

from typedcan.supervise.bit_places import byte_order, numbering
from typedcan.supervise.events import NotSeen, SignalKind, State, StateChanged, SupervisionEvent
from typedcan.supervise.frame_parts import Parts, frames_of, time_between
from typedcan.supervise.periods import Periods
from typedcan.supervise.signal_watch import Signals, Watch, watched_fields
from typedcan.supervise.snapshot import MessageSnapshot
from typedcan.wire.link import Fault, Received
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_FAULTS = ("length", "checksum", "counter repeated", "counter skipped", "counter invalid", "format")
_NOTHING: tuple[SupervisionEvent, ...] = ()
_ALIVE = State.ALIVE


class TrackedMessage:
    """What is known of one message; times are seconds of the clock, handed in.

    ``period``, ``late`` and ``timeout`` are the expected period and the silence after which the
    message is late and lost, in seconds; infinite where it never is. Frames with a wrong length,
    checksum, counter or format are counted in ``faults``.
    """

    __slots__ = (
        "_missed",
        "_onsets",
        "_parts",
        "_periods",
        "_signals",
        "_stamp",
        "_unmeasured",
        "_waiting_since",
        "expected",
        "faults",
        "frames",
        "kind",
        "last",
        "late",
        "period",
        "state",
        "timeout",
    )

    def __init__(self, kind: type[Message], protocol: Protocol) -> None:
        self.kind = kind
        self.expected = False
        self.period = kind.PERIOD
        self.late = math.inf
        self.timeout = math.inf
        self.state = State.NEVER_SEEN
        self.frames = 0
        self.last = -math.inf
        self.faults: dict[str, int] = dict.fromkeys(_FAULTS, 0)
        self._stamp = math.nan
        self._waiting_since = math.inf
        self._missed = False
        self._unmeasured = 0
        self._onsets: dict[SignalKind, int] = {}
        self._periods = Periods()
        transfer = frames_of(protocol, kind)
        fields = watched_fields(protocol, kind)
        order = byte_order(kind)
        self._parts: Parts | None = None
        if transfer:
            bits = numbering(protocol, transfer)
            self._parts = Parts(transfer, bits, order, fields, self._periods, self._onsets)
            fields = {name: fields[name] for name in fields if (kind, name) not in transfer.items}
        watch = Watch(fields.values(), order)
        self._signals = Signals(watch, self._onsets) if watch.fields else None

    def wait_from(self, now: float) -> None:
        """Silence before this moment does not count."""
        self._waiting_since = now
        self._missed = False

    @property
    def deadline(self) -> float:
        """When time alone changes something; infinite for never."""
        since = max(self.last, self._waiting_since)
        if self.state is _ALIVE:
            return since + min(self.late, self.timeout)
        if self.state is State.LATE or (self.state is State.NEVER_SEEN and not self._missed):
            return since + self.timeout
        return math.inf

    def overdue(self, now: float) -> SupervisionEvent:
        """What its ``deadline``, which has passed, changes."""
        if self.state is State.NEVER_SEEN:
            self._missed = True
            return NotSeen(self.kind, now)
        is_lost = now >= max(self.last, self._waiting_since) + self.timeout
        return self._go(State.LOST if is_lost else State.LATE, now, now - self.last)

    def take(
        self, received: Received[Message], now: float, stamp: float
    ) -> tuple[SupervisionEvent, ...]:
        """A message came in its frame; ``stamp`` is the frame's timestamp."""
        elapsed = now - self.last
        measured = time_between(stamp, self._stamp, elapsed)
        events: tuple[SupervisionEvent, ...] = _NOTHING
        if self.state is not _ALIVE or measured > self.late or measured > self.timeout:
            events = self._arrived(now, min(measured, elapsed))
        self.last = now
        self._stamp = stamp
        if received.faults:
            self.count(*received.faults)
        if self._parts is not None:
            events += self._take_part(self._parts, received, now, stamp)
        elif self.frames:
            self._periods.add(measured)
        self.frames += 1
        if self._signals is not None:
            changed = self._signals.take(received, now)
            if changed:
                events += tuple(changed)
        return events

    def count(self, *faults: Fault) -> None:
        """Count what is wrong with a frame."""
        for fault in faults:
            self.faults[f"counter {fault.counter}" if fault.counter else fault.kind] += 1

    def snapshot(self, now: float) -> MessageSnapshot:
        """All of it as plain data."""
        signals = self._signals.snapshot(self.kind) if self._signals else []
        if self._parts:
            signals.extend(self._parts.snapshot(self.kind))
        return MessageSnapshot(
            name=self.kind.NAME,
            sender=self.kind.SENDER,
            expected=self.expected,
            expected_period=self.period,
            state=self.state,
            age=now - self.last if self.frames else None,
            frames=self.frames,
            unmeasured=self._unmeasured,
            period=self._periods.stats(),
            faults=dict(self.faults),
            onsets=dict(self._onsets),
            signals=tuple(signals),
        )

    def _take_part(
        self, parts: Parts, received: Received[Message], now: float, stamp: float
    ) -> tuple[SupervisionEvent, ...]:
        try:
            return tuple(parts.take(received, now, stamp) or ())
        except LookupError:
            self._unmeasured += 1
            return _NOTHING

    def _arrived(self, now: float, between: float) -> tuple[SupervisionEvent, ...]:
        """What a frame changes that came so long after the one before.

        A silence that ended before anybody looked is reported all the same. It is measured as
        ``between``: a frame that only waited for the receiver was not late.
        """
        if self.state is State.NEVER_SEEN:
            return (self._go(_ALIVE, now, math.inf),)
        events: list[SupervisionEvent] = []
        silence = min(between, now - self._waiting_since)
        if silence > self.timeout and self.state is not State.LOST:
            events.append(self._go(State.LOST, now, between))
        elif silence > self.late and self.state is _ALIVE:
            events.append(self._go(State.LATE, now, between))
        if self.state is not _ALIVE:
            events.append(self._go(_ALIVE, now, now - self.last))
        return tuple(events)

    def _go(self, state: State, now: float, silence: float) -> StateChanged:
        old, self.state = self.state, state
        return StateChanged(self.kind, old, state, now, silence)
