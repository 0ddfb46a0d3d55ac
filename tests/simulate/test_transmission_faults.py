"""Each fault of the transmission of each message: noticed in time, named, and got over."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import product
from typing import Any

import pytest
from defaults import default_of

from swapcan import Fault
from swapcan._generated.protocol import PROTOCOL
from swapcan.node import Node
from swapcan.nodes.faults import FaultyBus
from typedcan.node.clock import SimulatedClock
from typedcan.simulate.faults import TRANSMISSION_FAULTS, can_have
from typedcan.simulate.participant import Participant
from typedcan.simulate.simulated_bus import SimulatedBus, SimulatedWire
from typedcan.simulate.world import World
from typedcan.supervise import State, StateChanged
from typedcan.wire.message import Message

CYCLIC = [message for message in PROTOCOL.messages if message.PERIOD]
CASES = [
    (message, fault)
    for message, fault in product(CYCLIC, sorted(TRANSMISSION_FAULTS))
    if can_have(message, fault)
    # The standard does not say how these are computed, so nobody can check them.
    and not (fault == "wrong_checksum" and message.CHECKSUM and message.CHECKSUM.algorithm != "xor")
]
NEEDED = ("charge_control", "reqst_tms_hv_on", "charger_start")
"""What has to be given where a message has it; 1 is stop or off."""

BEGIN, LONG = 3, 9
"""When the fault begins, and for how long it is there, in periods."""


class Somebody(Participant):
    """A node and nothing more."""

    name = "somebody"

    def step(self, now: float) -> None:
        """Do nothing."""


@dataclass
class Watched:
    """A sender, its bus, and what the receiver noticed at which second."""

    message: type[Message]
    world: World
    bus: FaultyBus
    receiver: Node
    events: list[tuple[float, Any]] = field(default_factory=list)

    def run(self, periods: float) -> None:
        assert self.message.PERIOD
        self.world.run(periods * self.message.PERIOD)

    def noticed(self) -> list[str]:
        """What was noticed, in order: states, and how counters and checksums were wrong."""
        return [
            event.new.value if isinstance(event, StateChanged) else event.counter or event.kind
            for _, event in self.events
        ]


@pytest.fixture
def watched(request: pytest.FixtureRequest) -> Iterator[Watched]:
    message: type[Message] = request.param
    clock = SimulatedClock()
    wire = SimulatedWire(clock)
    with FaultyBus(SimulatedBus(wire), clock=clock) as bus, SimulatedBus(wire) as other:
        sender = Node(PROTOCOL, message.SENDER, bus, clock=clock, expect=[])
        receiver = Node(PROTOCOL, message.RECEIVERS[0], other, clock=clock, expect=[message])
        sender.set(default_of(message), period=message.PERIOD)
        world = World(Somebody(sender), Somebody(receiver), clock=clock, wires=[wire])
        world.after_each_step(bus.release)
        watched = Watched(message, world, bus, receiver)
        for kind in (StateChanged, Fault):
            receiver.on(kind, lambda event: watched.events.append((clock.now(), event)))
        yield watched


def expected(message: type[Message], fault: str) -> set[str]:
    """What is noticed of a fault while it is there."""
    skipped = {"skipped"} if message.COUNTER else set[str]()
    return {
        "lost_frame": {"late", "alive"} | skipped,
        "late_frame": {"late", "alive"},
        "bus_silence": {"late", "lost"},
        "stuck_counter": {"repeated"},
        # A frame that is refused is missing too.
        "wrong_checksum": {"checksum", "late", "alive"} | skipped,
    }[fault]


@pytest.mark.parametrize(
    ("watched", "fault"),
    CASES,
    indirect=["watched"],
    ids=[f"{message.NAME}-{fault}" for message, fault in CASES],
)
def test_a_fault_is_noticed_in_time_named_and_got_over(watched: Watched, fault: str) -> None:
    period = watched.message.PERIOD
    assert period
    watched.run(BEGIN)
    assert watched.noticed() == ["alive"]
    watched.events.clear()

    watched.bus.inject(fault, watched.message)
    began = watched.world.clock.now()
    watched.run(LONG)
    watched.bus.heal(fault)
    assert set(watched.noticed()) == expected(watched.message, fault)
    first = next(at for at, event in watched.events)
    assert began < first <= began + 5 * period
    if fault == "bus_silence":
        lost = next(at for at, event in watched.events if event.new is State.LOST)
        assert lost <= began + 5 * period

    watched.run(3)
    assert watched.receiver.state(watched.message) is State.ALIVE
    watched.events.clear()
    watched.run(6)
    assert watched.noticed() == []


def test_every_message_and_every_fault_is_among_the_cases() -> None:
    assert {fault for _, fault in CASES} == TRANSMISSION_FAULTS
    assert {message for message, _ in CASES} == set(CYCLIC)
    assert len(CASES) == 3 * 22 + 4 + 6
