"""A wire in this process, and buses of python-can on it, whose time is that of a given clock."""

from __future__ import annotations

from copy import copy
from queue import Empty, SimpleQueue

import can

from typedcan.node.clock import Clock


class SimulatedWire:
    """What connects simulated buses.

    Frames take no time, and arrive on all buses in the order in which these joined, so that the
    same run gives the same frames.

    Parameters
    ----------
    clock
        Gives the timestamps.
    name
        The channel of its buses and of the frames received on them.
    """

    def __init__(self, clock: Clock, name: str = "simulated") -> None:
        self.clock = clock
        self.name = name
        self.carried = 0  # frames so far
        self._buses: list[SimulatedBus] = []

    def join(self, bus: SimulatedBus) -> None:
        """Let a bus take part."""
        self._buses.append(bus)

    def leave(self, bus: SimulatedBus) -> None:
        """Let a bus take part no more."""
        self._buses.remove(bus)

    def carry(self, frame: can.Message, sender: SimulatedBus) -> None:
        """Give a frame to all buses but its sender's."""
        self.carried += 1
        now = self.clock.now()
        for bus in self._buses:
            if bus is not sender:
                arrived = copy(frame)
                arrived.timestamp = now
                arrived.channel = self.name
                arrived.is_rx = True
                bus.put(arrived)


class SimulatedBus(can.BusABC):
    """A node's access to a simulated wire.

    Waiting for a frame with a timeout takes real time, as with every bus of python-can: on a
    simulated clock, receive with a timeout of 0.

    Parameters
    ----------
    wire
        The wire to join, until `shutdown`.
    can_filters
        As python-can has them.
    """

    def __init__(
        self, wire: SimulatedWire, can_filters: can.typechecking.CanFilters | None = None
    ) -> None:
        self._wire = wire
        self._arrived: SimpleQueue[can.Message] = SimpleQueue()
        self.channel_info = f"simulated wire {wire.name}"
        super().__init__(channel=wire.name, can_filters=can_filters)
        wire.join(self)

    def put(self, frame: can.Message) -> None:
        """Have a frame arrive, if the filters let it."""
        if self._matches_filters(frame):
            self._arrived.put(frame)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:  # noqa: ARG002
        """Send a frame; raises `can.CanOperationError` once the bus is shut down."""
        self._check()
        self._wire.carry(msg, self)

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        self._check()
        try:
            return self._arrived.get(block=timeout != 0, timeout=timeout), True
        except Empty:
            return None, True

    def shutdown(self) -> None:
        """Leave the wire."""
        if not self._is_shutdown:
            self._wire.leave(self)
        super().shutdown()

    def _check(self) -> None:
        if self._is_shutdown:
            raise can.CanOperationError("the bus is shut down")
