"""Somebody on a simulated wire who is none of the simulated nodes: sends, listens, remembers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeVar

import can

from swapcan import Fault, Link, Received
from swapcan.nodes.world import Participant, World
from swapcan.wire import Receiver
from typedcan.node.clock import SimulatedClock
from typedcan.simulate.simulated_bus import SimulatedBus, SimulatedWire
from typedcan.wire.message import Message

MessageT = TypeVar("MessageT", bound=Message)
ParticipantT = TypeVar("ParticipantT", bound=Participant)


class Outside:
    """The rest of the world of one participant.

    ``say`` has a message sent at its period until it is said otherwise; ``heard`` are all
    messages of the participant with the seconds at which they came.
    """

    def __init__(self, world: World, bus: can.BusABC) -> None:
        self._world = world
        self._bus = bus
        self._link = Link(bus)
        self._receiver = Receiver()
        self._said: dict[type[Message], tuple[Message, float]] = {}
        self.heard: list[tuple[float, Message]] = []
        self.faults: list[Fault] = []

    def say(self, message: Message) -> None:
        """Send a message again and again."""
        self._said[type(message)] = (message, self._world.elapsed)

    def hush(self, kind: type[Message]) -> None:
        """Send a message no more."""
        del self._said[kind]

    def run(self, seconds: float) -> None:
        """Let time pass, 10 ms at a time."""
        for _ in range(round(seconds * 100)):
            self._send()
            self._world.run(0.01)
            while frame := self._bus.recv(0):
                taken = self._receiver.take(frame)
                if isinstance(taken, Received):
                    self.heard.append((frame.timestamp, taken.message))
                    self.faults.extend(taken.faults)
                elif taken:
                    self.faults.append(taken)

    def last(self, kind: type[MessageT]) -> MessageT:
        """The last message of a kind that was heard."""
        return self.all(kind)[-1]

    def all(self, kind: type[MessageT]) -> list[MessageT]:
        """All messages of a kind that were heard."""
        return [message for _, message in self.heard if isinstance(message, kind)]

    def times(self, kind: type[Message]) -> list[float]:
        """When the messages of a kind came."""
        return [time for time, message in self.heard if isinstance(message, kind)]

    def _send(self) -> None:
        now = self._world.elapsed
        for kind, (message, due) in self._said.items():
            if due <= now + 1e-9:
                self._link.send(message)
                self._said[kind] = (message, due + (kind.PERIOD or 3600.0))


@contextmanager
def alone(
    make: Callable[[can.BusABC, SimulatedClock], ParticipantT],
) -> Iterator[tuple[ParticipantT, Outside, World]]:
    """One participant on a simulated wire, and the rest of its world."""
    clock = SimulatedClock()
    wire = SimulatedWire(clock)
    with SimulatedBus(wire) as bus, SimulatedBus(wire) as other:
        participant = make(bus, clock)
        world = World(participant, clock=clock, wires=[wire])
        yield participant, Outside(world, other), world
