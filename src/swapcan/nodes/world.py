"""Participants that share a high-voltage line, and the world in which they do."""

from __future__ import annotations

from collections.abc import Sequence

from swapcan.plant.line import Line
from typedcan.node.clock import Clock
from typedcan.node.node import Node
from typedcan.simulate import participant, world
from typedcan.simulate.simulated_bus import SimulatedWire


class Participant(participant.Participant):
    """A participant that may be on a high-voltage `Line` with others.

    See `typedcan.simulate.participant.Participant`.
    """

    def __init__(self, *nodes: Node) -> None:
        super().__init__(*nodes)
        self.line: Line | None = None


class World(world.World):
    """Lets participants live that share a `Line`; see `typedcan.simulate.world.World`.

    The line carries what those of them give and draw that set its values.
    """

    def __init__(
        self,
        *participants: participant.Participant,
        clock: Clock | None = None,
        wires: Sequence[SimulatedWire] = (),
    ) -> None:
        super().__init__(*participants, clock=clock, wires=wires)
        self.line = Line()
        for each in participants:
            if isinstance(each, Participant):
                each.line = self.line
