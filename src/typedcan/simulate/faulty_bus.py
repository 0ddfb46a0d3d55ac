"""A bus of python-can that loses, delays or spoils what is sent on it, on command."""

from __future__ import annotations

import math
import threading
from collections import Counter, deque
from collections.abc import Callable
from copy import copy

import can

from typedcan.model.checksums.registry import Given
from typedcan.model.layout import bits_reader, bits_writer
from typedcan.model.seal import seals_of
from typedcan.node.clock import Clock, SystemClock
from typedcan.simulate.echoes import Identifier, identifier_of
from typedcan.simulate.faults import TRANSMISSION_FAULTS, can_have
from typedcan.simulate.times import PlanError
from typedcan.wire.database import database
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_AT_MOST = 0.1
"""Seconds to wait for another thread that is sending or receiving."""

_EVERY = 4
"""One frame in so many is lost, late, or has a wrong checksum."""

_HELD_PERIODS = 2.5
"""How long a late frame is held back: longer than what is called late, shorter than a timeout."""

_HELD = 0.25
"""The same in seconds, for messages without a period."""


class FaultyBus(can.BusABC):
    """Stands for a bus and sends on it, with faults; what is received is not touched.

    It belongs to any node, simulated or not, that is to have such faults. `shutdown` shuts down
    the other bus too.

    Parameters
    ----------
    bus
        The bus to send on.
    protocol, algorithms
        As `Codec` has them; needed to make checksums right again.
    clock
        What a late frame waits by.
    """

    def __init__(
        self,
        bus: can.BusABC,
        protocol: Protocol,
        *,
        clock: Clock | None = None,
        algorithms: Given | None = None,
    ) -> None:
        self._bus = bus
        self._clock = clock or SystemClock()
        self._entries = database(protocol)
        self._seals = seals_of(protocol.model.messages, algorithms or {})
        # How many-th frames a fault hits, by the fault and the message, None for all messages.
        self._active: dict[tuple[str, type[Message] | None], int] = {}
        self._seen: Counter[tuple[str, Identifier]] = Counter()
        self._stuck: dict[type[Message], int] = {}
        self._held: dict[Identifier, deque[tuple[float, can.Message]]] = {}
        self._lock = threading.RLock()  # a node may send in one thread and receive in another
        self.channel_info = f"{bus.channel_info}, with faults"
        super().__init__(channel=self.channel_info)

    @property
    def active_faults(self) -> frozenset[str]:
        """The faults that it has now."""
        return frozenset(fault for fault, _ in self._active)

    def inject(self, fault: str, *messages: type[Message], every: int | None = None) -> None:
        """Have a fault from now on, besides those that are there.

        Parameters
        ----------
        fault
            lost_frame, late_frame, stuck_counter, wrong_checksum or bus_silence.
        messages
            Whose frames have it; those of all messages where none is given.
        every
            Hits the first and then each so many-th frame of a message. The default is 4, and 1
            for stuck_counter and bus_silence.

        Raises
        ------
        PlanError
            There is no such fault, or a message cannot have it.
        """
        if fault not in TRANSMISSION_FAULTS:
            known = ", ".join(sorted(TRANSMISSION_FAULTS))
            raise PlanError(f"frames cannot have the fault {fault!r}; known: {known}")
        for message in messages:
            if not can_have(message, fault):
                raise PlanError(f"the frames of {message.NAME} cannot have {fault}")
        if every is None:
            every = 1 if fault in ("stuck_counter", "bus_silence") else _EVERY
        with self._lock:
            self.heal(fault, *messages)
            self._active.update({(fault, message): every for message in messages or (None,)})

    def heal(self, fault: str, *messages: type[Message]) -> None:
        """Have a fault no more: that of some messages, or all of it where none is given.

        Nothing happens where it is not there.
        """
        with self._lock:
            for active in [key for key in self._active if key[0] == fault]:
                if not messages or active[1] in messages:
                    del self._active[active]
            for seen in [key for key in self._seen if key[0] == fault]:
                number, extended = seen[1]
                entry = self._entries.entry(number, extended=extended)
                if not messages or (entry and entry.type in messages):
                    del self._seen[seen]
            if fault == "stuck_counter":
                for message in messages or tuple(self._stuck):
                    self._stuck.pop(message, None)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Send a frame, or what the faults make of it; raises as the other bus does."""
        # Who has it may have been interrupted by a signal: then the safe codes go out all the same.
        if not self._lock.acquire(timeout=_AT_MOST):
            self._bus.send(msg, timeout)
            return
        try:
            self._send(msg, timeout)
        finally:
            self._lock.release()

    def _send(self, msg: can.Message, timeout: float | None) -> None:
        self.release()
        kind = self._kind(msg)
        if self._hits("bus_silence", msg, kind) or self._hits("lost_frame", msg, kind):
            return
        frame = self._altered(msg, kind) if kind else msg
        queue = self._held.get(identifier_of(msg))
        due = queue[-1][0] if queue else -math.inf  # frames of a message keep their order
        if self._hits("late_frame", msg, kind):
            due = max(due, self._clock.now() + _holding_time(kind))
        if due == -math.inf:
            self._bus.send(frame, timeout)
        else:
            self._held.setdefault(identifier_of(msg), deque()).append((due, copy(frame)))

    def release(self) -> None:
        """Send the frames that were held back long enough, as `send` and `recv` do too."""
        if not self._held:
            return
        with self._lock:
            now = self._clock.now()
            for identifier, queue in list(self._held.items()):
                while queue and queue[0][0] <= now:
                    self._bus.send(queue.popleft()[1])
                if not queue:
                    del self._held[identifier]

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        if self._held:
            self.release()
            with self._lock:
                due = min((queue[0][0] for queue in self._held.values()), default=math.inf)
            if timeout != 0 and due < math.inf:
                wait = max(0.0, due - self._clock.now())
                timeout = wait if timeout is None else min(timeout, wait)
        frame = self._bus.recv(timeout)
        # Not left to python-can: its recv(0) ends at the first frame that the filters reject.
        while frame and not self._matches_filters(frame):
            frame = self._bus.recv(0)
        return frame, True

    def shutdown(self) -> None:
        """Shut down the other bus too; frames held back are dropped."""
        if not self._is_shutdown:
            self._held.clear()
            self._bus.shutdown()
        super().shutdown()

    def _kind(self, frame: can.Message) -> type[Message] | None:
        entry = self._entries.entry(frame.arbitration_id, extended=frame.is_extended_id)
        whole = not frame.is_remote_frame and not frame.is_error_frame
        fits = entry is not None and len(frame.data) == entry.type.MODEL.frame_length
        return entry.type if entry and whole and fits else None

    def _hits(self, fault: str, frame: can.Message, kind: type[Message] | None) -> bool:
        if not self._active:
            return False
        every = self._active.get((fault, kind)) or self._active.get((fault, None))
        if every is None:
            return False
        key = (fault, identifier_of(frame))
        self._seen[key] += 1
        return (self._seen[key] - 1) % every == 0

    def _altered(self, frame: can.Message, kind: type[Message]) -> can.Message:
        data = bytes(frame.data[: kind.LENGTH])  # without what fills up a CAN FD frame
        if kind.COUNTER and self._hits("stuck_counter", frame, kind):
            read, write = _bits(kind, kind.COUNTER.signal)
            data = write(data, self._stuck.setdefault(kind, read(data)))
            seal = self._seals.get(kind.NAME)
            data = seal.filled(data) if seal else data
        if kind.CHECKSUM and self._hits("wrong_checksum", frame, kind):
            read, write = _bits(kind, kind.CHECKSUM.signal)
            ones = (1 << kind.MODEL.signal(kind.CHECKSUM.signal).length) - 1
            data = write(data, read(data) ^ ones)
        if data == frame.data[: kind.LENGTH]:
            return frame
        altered = copy(frame)
        altered.data = bytearray(data) + frame.data[kind.LENGTH :]
        return altered


def _bits(
    kind: type[Message], name: str
) -> tuple[Callable[[bytes], int], Callable[[bytes, int], bytes]]:
    """What reads and what writes a signal."""
    signal = kind.MODEL.signal(name)
    return bits_reader(signal, kind.LENGTH), bits_writer(signal, kind.LENGTH)


def _holding_time(kind: type[Message] | None) -> float:
    return _HELD_PERIODS * kind.PERIOD if kind and kind.PERIOD else _HELD
