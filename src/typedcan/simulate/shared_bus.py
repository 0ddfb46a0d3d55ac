"""One bus of python-can for several nodes of one process, which hear each other too."""

from __future__ import annotations

import time
from collections import deque
from copy import copy

import can

from typedcan.simulate.echoes import Echoes


class SharedBus:
    """Hands a bus to several nodes, as many adapters can be opened only once.

    What one node sends goes out on the bus and to the other nodes here, what arrives on the bus
    goes to all of them, save for what an interface gives back of what was sent on it. All nodes
    live in one thread. The bus is lent.

    ``sent`` and ``received`` count the frames that went out on the bus and came in from others.
    """

    def __init__(self, bus: can.BusABC) -> None:
        self.bus = bus
        self.sent = 0
        self.received = 0
        self._shares: list[Share] = []
        self._echoes = Echoes()

    def share(self) -> Share:
        """A bus for one more node."""
        share = Share(self)
        self._shares.append(share)
        return share

    def leave(self, share: Share) -> None:
        """Give nothing more to a share."""
        self._shares.remove(share)

    def send(self, frame: can.Message, timeout: float | None, sender: Share) -> None:
        """Send a node's frame; raises as the bus does."""
        self.bus.send(frame, timeout)
        self._echoes.sent(frame, time.monotonic())
        self.sent += 1
        for share in self._shares:
            if share is not sender:
                arrived = copy(frame)
                arrived.timestamp = time.time()
                arrived.is_rx = True
                share.arrived.append(arrived)

    def receive(self, timeout: float | None) -> None:
        """Take the next frame of the bus, if one comes in time; raises as the bus does."""
        frame = self.bus.recv(timeout)
        while frame and self._echoes.is_one(frame, time.monotonic()):
            frame = self.bus.recv(0)
        if frame is None:
            self._echoes.heard_all(time.monotonic())
        else:
            self.received += 1
            for share in self._shares:
                share.arrived.append(frame)


class Share(can.BusABC):
    """What one node has of a shared bus; shutting it down leaves the bus open."""

    def __init__(self, shared: SharedBus) -> None:
        self._shared = shared
        self.arrived: deque[can.Message] = deque()
        self.channel_info = f"{shared.bus.channel_info}, shared"
        super().__init__(channel=self.channel_info)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Send a frame; raises as the bus does."""
        self._shared.send(msg, timeout, self)

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        if not self.arrived:
            self._shared.receive(timeout)
        return (self.arrived.popleft() if self.arrived else None), False

    def shutdown(self) -> None:
        """Leave the shared bus, which stays open."""
        if not self._is_shutdown:
            self._shared.leave(self)
        super().shutdown()
