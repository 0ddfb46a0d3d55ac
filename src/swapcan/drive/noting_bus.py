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

from swapcan._generated.protocol import PROTOCOL
from swapcan.wire import Codec
from typedcan.model.errors import TypedcanError
from typedcan.wire.acting import SentCommands, acting_fields
from typedcan.wire.clock import Clock, SystemClock
from typedcan.wire.message import Message

_BEHIND = 0.1
"""Seconds for which a frame waits for those that came before it and are read after it."""

_ECHO = 5.0
"""Seconds in which an interface gives back what was sent, to a process that may be held up.

Later the same bytes are another's."""

_NO_TIME = 3600.0
"""Seconds between an adapter's time and the system's, as they were at first, that cannot be."""

_OTHER_TIME = 1.0
"""Seconds between the adapter's time and the system's from which on they count as different."""


class NotingBus(can.BusABC):
    """Stands for a bus that is lent; `shutdown` leaves it open.

    An interface that gives back what was sent on it is no trouble: such frames are dropped. What
    is sent with a code that acts is kept in mind, whoever made the frame, so that
    `send_safe_codes` can end it whatever else has failed.

    Parameters
    ----------
    bus
        The bus to send and receive on.
    note
        Is told of each frame, received or sent, the latter with ``is_rx`` False. Once it raises
        it is told no more, and `failure` has the error: what drives a pack must not be held up by
        a full disk.
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
        self._codec = Codec()
        self._commands = SentCommands()
        self._acting_ids = {kind.FRAME_ID for kind in PROTOCOL.messages if acting_fields(kind)}
        self.latest: dict[int, can.Message] = {}
        """The last frame of others, by identifier; none from before the last code that acts."""
        self.has_acted = False
        """Whether a code that acts was ever sent."""
        self.intruder: can.Message | None = None
        self.failure: Exception | None = None
        self.trouble: tuple[float, Exception] | None = None
        self.channel_info = bus.channel_info
        super().__init__(channel=bus.channel_info)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Send a frame; raises as the bus does."""
        command = self._command_in(msg)
        if command:
            self._commands.begin(command)
            if self.acting:
                self.has_acted = True
                self.latest.clear()
        self._send(msg, timeout)
        if command:
            self._commands.end(command)

    @property
    def acting(self) -> tuple[Message, ...]:
        """The messages that were sent last with a code that acts, as far as is known."""
        return self._commands.acting

    def send_safe_codes(self) -> Exception | None:
        """Send each message that can act and was sent, with its safe codes, and nothing else.

        Returns what the first one raised that could not be sent; the others are sent all the same.
        """
        failure: Exception | None = None
        for message in self._commands.all:
            try:
                self._send(self._safe_frame(message), 0)
            except Exception as error:  # noqa: BLE001 - drivers raise what they like
                failure = failure or error
            else:
                self._commands.made_safe(message)
        return failure

    def _command_in(self, frame: can.Message) -> Message | None:
        """The message that can act in a frame, if there is one."""
        if frame.arbitration_id not in self._acting_ids or not frame.is_extended_id:
            return None
        try:
            return self._codec.decode(frame.arbitration_id, bytes(frame.data), verify=False)
        except TypedcanError:
            return None

    def _safe_frame(self, message: Message) -> can.Message:
        kind = type(message)
        counter = None
        if kind.COUNTER:
            last = getattr(message, kind.COUNTER.field)
            counter = (last + 1) % kind.COUNTER.modulus if isinstance(last, int) else 0
        data = self._codec.encode(message, counter=counter, renew=True, safe=True)
        frame = can.Message(arbitration_id=kind.FRAME_ID, is_extended_id=True, data=data)
        self._commands.begin(self._codec.decode(kind.FRAME_ID, data, verify=False))
        return frame

    def _send(self, msg: can.Message, timeout: float | None) -> None:
        try:
            self._bus.send(msg, timeout)
        except Exception as error:
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
        except Exception as error:
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
        if not frame.timestamp or not math.isfinite(frame.timestamp):
            return now
        if self._shift is None:
            shift = now - frame.timestamp
            self._shift = shift if abs(shift) > _OTHER_TIME else 0.0
        moment = frame.timestamp + self._shift
        if abs(moment - now) > _NO_TIME:
            return now
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
                except Exception as error:  # noqa: BLE001 - recorders raise what they like
                    self.failure = error
