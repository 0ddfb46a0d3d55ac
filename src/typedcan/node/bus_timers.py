"""Cyclic messages that the bus's own interface repeats, such as the kernel does for SocketCAN."""

from __future__ import annotations

import can
from can.broadcastmanager import CyclicSendTaskABC, ModifiableCyclicTaskABC

from typedcan.wire.message import Message


def has_timers(bus: can.BusABC) -> bool:
    """Whether an interface repeats frames by itself.

    The others inherit python-can's way: a thread for each message, which is less punctual than
    the one thread of a node.
    """
    inherited = can.BusABC.__dict__["_send_periodic_internal"]
    return getattr(bus.__class__, "_send_periodic_internal", inherited) is not inherited


class BusTimers:
    """The tasks that were started on a bus, by message; others on that bus are left alone."""

    def __init__(self) -> None:
        self._tasks: dict[type[Message], tuple[CyclicSendTaskABC, can.BusABC, float]] = {}

    def __contains__(self, kind: object) -> bool:
        return kind in self._tasks

    def begin(
        self, kind: type[Message], bus: can.BusABC, frame: can.Message, period: float
    ) -> None:
        """Let a bus repeat a frame; raises what the bus raises."""
        self._tasks[kind] = (bus.send_periodic(frame, period), bus, period)

    def change(self, kind: type[Message], frame: can.Message) -> None:
        """Repeat this frame instead, in the same rhythm where the interface can."""
        task, bus, period = self._tasks[kind]
        if isinstance(task, ModifiableCyclicTaskABC):
            task.modify_data(frame)
        else:
            self.end(kind)
            self.begin(kind, bus, frame, period)

    def end(self, kind: type[Message]) -> None:
        """Repeat a message no more; raises what the bus raises."""
        if kind in self._tasks:
            self._tasks.pop(kind)[0].stop()

    def kinds(self) -> tuple[type[Message], ...]:
        """The messages that are repeated."""
        return tuple(self._tasks)
