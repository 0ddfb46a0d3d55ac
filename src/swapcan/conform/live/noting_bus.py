"""A bus of python-can that tells what is received and sent on it, in the order of its times."""

from __future__ import annotations

import heapq
import itertools
import math
import time
from collections import defaultdict, deque
from collections.abc import Callable, Collection
from copy import copy

import can

from swapcan.clock import Clock, SystemClock
from swapcan.errors import SwapcanError

_BEHIND = 0.1
"""Seconds for which a frame waits for those that came before it and are read after it."""

_ECHO = 5.0
"""Seconds in which an interface gives back what was sent, to a process that may be held up.

Later the same bytes are another's."""

_OTHER_TIME = 1.0
"""Seconds between the adapter's time and the system's from which on they count as different."""


class NotingBus(can.BusABC):
    """Stands for a bus that is lent; `shutdown` leaves it open.

    An interface that gives back what was sent on it is no trouble: such frames are dropped.

    Parameters
    ----------
    bus
        The bus to send and receive on.
    note
        Is told of each frame, received or sent, the latter with ``is_rx`` False. Once it raises
        a `SwapcanError` it is told no more, and `failure` has the error: what drives a pack must
        not be held up by a full disk.
    clock
        Of those who send; on a simulated one frames must have its times.
    played
        Identifiers that nobody else may send: `intruder` is a frame of somebody who does.

    ``trouble`` is since when, by the clock, the bus refuses to work, and why.
    """

    def __init__(
        self,
        bus: can.BusABC,
        note: Callable[[can.Message], object],
        *,
        clock: Clock | None = None,
        played: Collection[int] = (),
    ) -> None:
        self._bus = bus
        self._note = note
        self._clock = clock or SystemClock()
        self._played = frozenset(played)
        real = isinstance(self._clock, SystemClock)
        self._wall = time.time() - self._clock.now() if real else 0.0
        self._shift: float | None = None
        self._lag = math.inf  # the least that a frame has been late by its own time
        self._sent: defaultdict[tuple[int, bytes], deque[float]] = defaultdict(deque)
        self._waiting: list[tuple[float, int, can.Message]] = []
        self._number = itertools.count()
        self._newest = 0.0
        self.latest: dict[int, can.Message] = {}
        """The last frame of others, by identifier."""
        self.intruder: can.Message | None = None
        self.failure: SwapcanError | None = None
        self.trouble: tuple[float, Exception] | None = None
        self.channel_info = bus.channel_info
        super().__init__(channel=bus.channel_info)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Send a frame; raises as the bus does."""
        try:
            self._bus.send(msg, timeout)
        except (can.CanError, OSError, ValueError) as error:
            self._fails(error)
            raise
        self.trouble = None
        self._sent[msg.arbitration_id, bytes(msg.data)].append(self._clock.now())
        sent = copy(msg)
        sent.is_rx = False
        # As the adapter would have it: else an answer might come before what it answers.
        self._take(sent, self._now() - (self._lag if math.isfinite(self._lag) else 0.0))

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        try:
            frame = self._bus.recv(timeout)
            while frame and self._is_echo(frame):
                frame = self._bus.recv(0)
        except (can.CanError, OSError, ValueError) as error:
            self._fails(error)
            raise
        if frame:
            self.latest[frame.arbitration_id] = frame
            if frame.arbitration_id in self._played and frame.is_extended_id:
                self.intruder = frame
            self._take(copy(frame), self._time_of(frame))
        return frame, False

    def shutdown(self) -> None:
        """Tell of what still waits; the bus stays open."""
        if not self._is_shutdown:
            self._tell(until=math.inf)
        super().shutdown()

    def _is_echo(self, frame: can.Message) -> bool:
        if not frame.is_rx:
            return True
        sent = self._sent.get((frame.arbitration_id, bytes(frame.data)), deque[float]())
        oldest = self._clock.now() - _ECHO
        while sent and sent[0] < oldest:
            sent.popleft()
        if sent:
            sent.popleft()
            return True
        return False

    def _fails(self, error: Exception) -> None:
        if self.trouble is None:
            self.trouble = self._clock.now(), error

    def _now(self) -> float:
        return self._wall + self._clock.now()

    def _time_of(self, frame: can.Message) -> float:
        """The time of a received frame as the system has it: some adapters have their own."""
        now = self._now()
        if not frame.timestamp:
            return now
        if self._shift is None:
            shift = now - frame.timestamp
            self._shift = shift if abs(shift) > _OTHER_TIME else 0.0
        moment = frame.timestamp + self._shift
        self._lag = min(self._lag, now - moment)
        return moment

    def _take(self, frame: can.Message, moment: float) -> None:
        frame.timestamp = moment
        frame.channel = None  # else what is sent and what is received would be on two
        heapq.heappush(self._waiting, (moment, next(self._number), frame))
        self._newest = max(self._newest, moment)
        self._tell(until=self._newest - _BEHIND)

    def _tell(self, until: float) -> None:
        while self._waiting and self._waiting[0][0] <= until:
            frame = heapq.heappop(self._waiting)[2]
            if self.failure is None:
                try:
                    self._note(frame)
                except SwapcanError as error:
                    self.failure = error
