"""What tests of live nodes share: a recorder of events, and nodes on a simulated clock."""

from __future__ import annotations

import threading
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import can

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import BMS_TMS_0, B2C_Charger, ChargeControl, HvRequest
from swapcan.node import Node
from typedcan.node.clock import SimulatedClock
from typedcan.wire.message import Message


class Recorder:
    """A callback that keeps what it is called with, and lets a test wait for it."""

    def __init__(self) -> None:
        self.seen: list[Any] = []
        self._changed = threading.Condition()

    def __call__(self, event: object) -> None:
        with self._changed:
            self.seen.append(event)
            self._changed.notify_all()

    def wait(self, count: int = 1, timeout: float = 5.0) -> list[Any]:
        """The first so many events, once they have come; fails where they do not."""
        with self._changed:
            assert self._changed.wait_for(lambda: len(self.seen) >= count, timeout), self.seen
            return self.seen[:count]

    def wait_until(self, fits: Callable[[Any], bool], timeout: float = 5.0) -> Any:
        """The first event that fits, once it has come."""
        with self._changed:
            assert self._changed.wait_for(lambda: any(map(fits, self.seen)), timeout), self.seen
            return next(filter(fits, self.seen))


class Bench:
    """Nodes on one simulated clock, each turned whenever it has something to do."""

    def __init__(self) -> None:
        self.clock = SimulatedClock()
        self.nodes: list[Node] = []

    def node(self, name: str, bus: can.BusABC, **options: Any) -> Node:
        """A node of the standard's protocol."""
        node = Node(PROTOCOL, name, bus, clock=self.clock, **options)
        self.nodes.append(node)
        return node

    def run(self, until: float) -> None:
        """Let the clock go to a time, from one moment at which a node is due to the next."""
        self.turn()
        while (due := min(node.next_due for node in self.nodes)) <= until:
            self.clock.advance_to(max(due, self.clock.now()))
            self.turn()
        self.clock.advance_to(until)
        self.turn()

    def turn(self) -> None:
        """Turn all nodes; twice, so that each takes what any other has sent."""
        for node in self.nodes * 2:
            node.turn()


def frames_on(bus: can.BusABC) -> list[can.Message]:
    """All frames that have arrived on a bus."""
    frames = []
    while frame := bus.recv(0):
        frames.append(frame)
    return frames


def at_rest(kind: type[Message]) -> Message:
    """A message that asks for nothing: also one whose fields have to be given."""
    if kind is B2C_Charger:
        return B2C_Charger(charge_control=ChargeControl.NORMAL_STOP_TO_CHARGE)
    if kind is BMS_TMS_0:
        return BMS_TMS_0(reqst_tms_hv_on=HvRequest.REQUEST_HV_OFF)
    return kind()


class Ear:
    """Notes at which time of the simulated clock which frame was sent."""

    def __init__(self, bench: Bench, bus: can.BusABC) -> None:
        self._bench = bench
        self._bus = bus
        self.heard: list[tuple[float, can.Message]] = []

    def run(self, until: float, step: float = 0.001) -> Ear:
        while self._bench.clock.now() < until - step / 2:
            self._bench.run(min(until, self._bench.clock.now() + step))
            now = self._bench.clock.now()
            self.heard += [(now, frame) for frame in frames_on(self._bus)]
        return self

    def times(self, kind: type[Message]) -> list[float]:
        return [time for time, frame in self.heard if frame.arbitration_id == kind.FRAME_ID]

    def data(self, kind: type[Message]) -> list[str]:
        frames = [frame for _, frame in self.heard if frame.arbitration_id == kind.FRAME_ID]
        return [frame.data.hex() for frame in frames]


def gaps(times: list[float]) -> list[float]:
    return [b - a for a, b in pairwise(times)]
