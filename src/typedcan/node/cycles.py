"""The cyclic messages of a node: where their frames come from, and sending what is due."""

from __future__ import annotations

import logging
import math
import threading
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass

from typedcan.node.bus_timers import BusTimers, has_timers
from typedcan.node.clock import Clock
from typedcan.node.port import Port
from typedcan.node.schedule import Schedule
from typedcan.node.transmit import Transmitter
from typedcan.wire.acting import acting_fields
from typedcan.wire.errors import SendingError
from typedcan.wire.message import Message

_LOG = logging.getLogger("typedcan")

Maker = Callable[[], Iterable[Message]]
"""Gives the frames of one cycle."""


@dataclass(frozen=True, slots=True)
class Source:
    """Where the frames of each cycle come from, and the period in seconds, if there is one.

    ``fixed`` frames are the same each time, and have been checked.
    """

    make: Maker
    period: float | None
    fixed: tuple[Message, ...] = ()

    @classmethod
    def of(cls, frames: tuple[Message, ...], period: float | None) -> Source:
        """The same frames each time."""
        return cls(lambda: frames, period, frames)


def frames_of(kind: type[Message], make: Maker, transmitter: Transmitter) -> tuple[Message, ...]:
    """The frames of one cycle; none where they cannot be made, which is reported."""
    try:
        frames = tuple(make())
    except Exception as error:  # noqa: BLE001 - what a user's function raises stops no node
        if transmitter.failed(kind, error):
            _LOG.exception("what is to make %s raised; the node goes on", kind.NAME)
        return ()
    wrong = [frame for frame in frames if type(frame) is not kind]
    if wrong:
        problem = f"was to be a {kind.NAME}, not {type(wrong[0]).__name__}"
        transmitter.failed(kind, SendingError(problem))
        return ()
    return frames


class Cycles:
    """Sends the cyclic messages of a node.

    What can be is handed to the bus's interface, where that repeats frames by itself: a message of
    one frame a cycle whose bytes are the same each time. All others need a counter, a checksum or
    values anew for each transmission, which no interface can fill in.

    Parameters
    ----------
    lock
        Guards what is changed by several threads; it must be reentrant.
    """

    def __init__(
        self,
        transmitter: Transmitter,
        port: Port,
        clock: Clock,
        lock: threading.Condition,
        *,
        phase: float,
    ) -> None:
        self._transmitter = transmitter
        self._port = port
        self._clock = clock
        self._lock = lock
        self._schedule = Schedule(phase)
        self._sources: dict[type[Message], Source] = {}
        self._under_way: dict[type[Message], tuple[Message, ...]] = {}
        self._timers = BusTimers()
        self._handed_over: dict[type[Message], float] = {}  # since when
        self._unfit: set[type[Message]] = set()
        self._uses_timers = False

    @property
    def next_due(self) -> float:
        """When the next frame is due; `math.inf` where none is."""
        return self._schedule.next_due

    def start(self, *, use_timers: bool) -> None:
        """Begin all cycles anew; ``use_timers``: hand over to the bus what it can repeat."""
        with self._lock:
            self._uses_timers = use_timers
            self._unfit.clear()
            self._schedule.restart(self._clock.now())

    def stop(self) -> None:
        """Take back what was handed over."""
        with self._lock:
            self._uses_timers = False
            self.take_all_back()

    def period(self, kind: type[Message]) -> float | None:
        """The period of a message that is being sent."""
        source = self._sources.get(kind)
        return source.period if source else None

    def begin(self, kind: type[Message], source: Source) -> None:
        """Send a message from now on, or other frames of one that is being sent."""
        period = source.period
        if period is None:
            raise SendingError(f"{kind.NAME} has no period of its own: give one")
        with self._lock:
            before = self._sources.get(kind)
            if kind in self._handed_over and not self._changed_in_place(kind, source, before):
                self._take_back(kind)
            if kind not in self._handed_over:
                self._schedule.add(kind, period, self._clock.now())
            self._sources[kind] = source

    def end(self, kind: type[Message]) -> None:
        """Send a message no more."""
        with self._lock:
            if kind in self._handed_over:
                self._take_back(kind)
            self._schedule.remove(kind)
            self._sources.pop(kind, None)

    def postpone(self, kind: type[Message], seconds: float) -> None:
        """Let the next frame of a message come so much later."""
        with self._lock:
            if kind not in self._sources:
                raise SendingError(f"{kind.NAME} is not being sent: set it first")
            if kind in self._handed_over:
                self._take_back(kind)
            self._schedule.postpone(kind, seconds)

    def take_all_back(self) -> None:
        """Take back what was handed over to a bus that is not there any more."""
        with self._lock:
            for kind in tuple(self._handed_over):
                self._take_back(kind)
            self._lock.notify_all()

    def send_next(self) -> bool:
        """Send the frame that has been due for longest; False where none is due."""
        now = self._clock.now()
        with self._lock:
            due = self._schedule.due(now)
            if due is None:
                return False
            kind, index = due
            source = self._sources[kind]
        if index == 0:
            self._under_way[kind] = frames_of(kind, source.make, self._transmitter)
        frames = self._under_way[kind]
        if self._hand_over(kind, source):
            return True
        if frames:
            self._transmitter.try_to_send(frames[index])
        with self._lock:
            self._schedule.went(kind, len(frames), now)
        return True

    def _hand_over(self, kind: type[Message], source: Source) -> bool:
        """Let the bus repeat a message; False where it cannot."""
        if not (self._uses_timers and self._fits(kind, source)) or source.period is None:
            return False
        with self._lock:
            if self._sources.get(kind) is not source:
                return True  # changed meanwhile: come back for the new one
            frame = self._transmitter.frame(source.fixed[0])
            try:
                self._timers.begin(kind, self._port.bus, frame, source.period)
            except Exception:  # noqa: BLE001 - what an interface cannot do is done here
                self._unfit.add(kind)
                return False
            self._handed_over[kind] = self._clock.now()
            self._schedule.remove(kind)
            return True

    def _fits(self, kind: type[Message], source: Source) -> bool:
        return (
            # What acts is not left to an interface: it would go on where this process has ended.
            not acting_fields(kind)
            and kind.COUNTER is None
            and len(source.fixed) == 1
            and kind not in self._unfit
            and has_timers(self._port.bus)
        )

    def _changed_in_place(self, kind: type[Message], source: Source, before: Source | None) -> bool:
        if not self._fits(kind, source) or before is None or before.period != source.period:
            return False
        try:
            self._timers.change(kind, self._transmitter.frame(source.fixed[0]))
        except Exception:  # noqa: BLE001 - as above
            self._unfit.add(kind)
            return False
        return True

    def _take_back(self, kind: type[Message]) -> None:
        """Go on here with what the bus repeated, at the times at which the bus would have."""
        since = self._handed_over.pop(kind)
        with suppress(Exception):  # a bus that is gone repeats nothing
            self._timers.end(kind)
        period = self._sources[kind].period
        if period is not None:
            cycles = math.floor((self._clock.now() - since) / period) + 1
            self._schedule.resume(kind, period, since + cycles * period)
