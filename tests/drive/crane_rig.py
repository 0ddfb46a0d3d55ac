"""A winch of somebody else's protocol beside a panel that is driven, on one simulated clock."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack

import can
from simulate.crane import BRAKE, CODEC, LIFT, UP, Panel, Winch

from typedcan.drive.departure import Departure
from typedcan.drive.driving import Driving
from typedcan.drive.noting_bus import NotingBus
from typedcan.node.clock import SimulatedClock
from typedcan.simulate.simulated_bus import SimulatedBus, SimulatedWire
from typedcan.simulate.world import World

LIFT_ID = (0x101, False)
STATE_ID = (0x181, False)


class Rig:
    """A panel that wants up, on a bus that is driven; ``around`` may put something before that."""

    def __init__(
        self, stack: ExitStack, around: Callable[[can.BusABC], can.BusABC] = lambda bus: bus
    ) -> None:
        self.clock = SimulatedClock()
        self.wire = SimulatedWire(self.clock)
        self.listener, self.other, beside, bare = (
            stack.enter_context(SimulatedBus(self.wire)) for _ in range(4)
        )
        self.bus = stack.enter_context(
            NotingBus(around(bare), CODEC, lambda _: None, clock=self.clock, played=[LIFT, BRAKE])
        )
        self.panel = Panel(self.bus, self.clock)
        self.panel.wanted = UP
        self.winch = Winch(beside, self.clock)
        self.driving = Driving([self.bus], clock=self.clock, wires=(self.wire,))
        self.world = World(self.panel, self.winch, clock=self.clock, wires=(self.wire,))

    def departure(self, **others: object) -> Departure:
        """The panel goes on to want what it wants, and the winch to live."""
        given = {"live_on": [self.panel, self.winch], "are_off": self.is_off, **others}
        return Departure(**given)  # type: ignore[arg-type]

    def is_off(self) -> bool:
        """Whether the winch has said that it stands since it was told last to move."""
        frame = self.bus.latest.get(STATE_ID)
        return frame is not None and frame.data[0] == 0

    def lifts(self) -> list[can.Message]:
        """Frames of Lift since this was asked last."""
        frames = []
        while frame := self.listener.recv(0):
            frames.append(frame)
        return [each for each in frames if (each.arbitration_id, each.is_extended_id) == LIFT_ID]
