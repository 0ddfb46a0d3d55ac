"""A pack under test beside the stage of scenarios, on one simulated clock."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from copy import copy

import can

from swapcan.messages import V2B_CMD
from swapcan.nodes.bmu import Bmu
from swapcan.scenarios.scenario import Scenario
from swapcan.scenarios.stage import Stage
from typedcan.node.clock import SimulatedClock
from typedcan.simulate.simulated_bus import SimulatedBus, SimulatedWire

MOST_SECONDS = 120.0
"""Longer than any scenario: a clock that goes further is one that nobody stops."""


class SharedClock(SimulatedClock):
    """A simulated clock that lets a pack live, on a wire of its own, while others advance it."""

    def __init__(self) -> None:
        super().__init__()
        self.pack: Bmu | None = None
        self._step = 0

    def advance_to(self, now: float) -> None:
        """Go on, and let the pack do all that is due until then, each at its moment."""
        assert now < MOST_SECONDS, "nobody stops this clock"
        while self.pack and (due := min(self._next_step, self.pack.node.next_due)) < now:
            super().advance_to(max(due, self.now()))
            self._live(self.pack)
        super().advance_to(now)

    @property
    def _next_step(self) -> float:
        return self._step * 0.01

    def _live(self, pack: Bmu) -> None:
        if self._next_step <= self.now():
            pack.step(self.now())
            self._step += 1
        pack.node.turn()


class Bench:
    """A pack on a wire, others beside it; ``frames`` are those of the record."""

    def __init__(self, around: Callable[[can.BusABC], can.BusABC] = lambda bus: bus) -> None:
        self.clock = SharedClock()
        self.wire = SimulatedWire(self.clock)
        self.listener = SimulatedBus(self.wire)
        self.outside = SimulatedBus(self.wire)
        self.tester = SimulatedBus(self.wire)
        self._pack_bus = around(SimulatedBus(self.wire))
        self.pack = Bmu(self._pack_bus, clock=self.clock)
        self.clock.pack = self.pack
        self.frames: list[can.Message] = []

    def close(self) -> None:
        """Shut all buses down."""
        for bus in (self.listener, self.outside, self.tester, self._pack_bus):
            bus.shutdown()

    def stage(self, is_over: Callable[[], bool] = lambda: False) -> Stage:
        """Where scenarios are played for this pack."""
        return Stage(self.tester, clock=self.clock, wires=(self.wire,), is_over=is_over)

    def play(self, scenario: Scenario, nodes: Sequence[str] = ()) -> Stage:
        """Play a scenario to its end."""
        stage = self.stage()
        stage.play(scenario, scenario.played(nodes), self.frames.append)
        return stage

    def heard(self) -> Iterator[can.Message]:
        """What came on the wire, from whomever, since this was asked last."""
        while frame := self.listener.recv(0):
            yield frame


@contextmanager
def bench(around: Callable[[can.BusABC], can.BusABC] = lambda bus: bus) -> Iterator[Bench]:
    """A bench; ``around`` may put something between the pack and its bus."""
    rig = Bench(around)
    try:
        yield rig
    finally:
        rig.close()


class Altered(can.BusABC):
    """What a bad pack makes of the commands that it receives: ``alter`` changes the bytes."""

    def __init__(self, bus: can.BusABC, alter: Callable[[bytearray], None]) -> None:
        self._bus, self._alter = bus, alter
        super().__init__(channel="altered")

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        self._bus.send(msg, timeout)

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        frame = self._bus.recv(timeout)
        if frame is None or frame.arbitration_id != V2B_CMD.FRAME_ID:
            return frame, True
        data = bytearray(frame.data)  # which others on the wire have too
        self._alter(data)
        data[0] = 0
        for byte in data[1:]:
            data[0] ^= byte
        altered = copy(frame)
        altered.data = data
        return altered, True

    def shutdown(self) -> None:
        self._bus.shutdown()
        super().shutdown()


def believe_any_checksum(data: bytearray) -> None:
    """A receiver that does not check: the right one is put in by `Altered`."""


def take_off_for_on(data: bytearray) -> None:
    """HV_OnOff is bits 4 and 5 of byte 1 (A.1): off becomes on."""
    data[1] = data[1] & ~0x30 | 0x10
