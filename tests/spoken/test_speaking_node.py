"""A live node that speaks an edition: its periods, its counters, its safe codes, and its events."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from typing import Any

import can
import pytest
from spoken.editions import PUMP, Command, Report, code

from typedcan.node.clock import SimulatedClock
from typedcan.node.node import Node
from typedcan.simulate.participant import Participant
from typedcan.simulate.simulated_bus import SimulatedBus, SimulatedWire
from typedcan.simulate.world import World
from typedcan.spoken.codec import SpokenCodec
from typedcan.supervise import NotSeen, SignalChanged, State, StateChanged
from typedcan.wire.errors import EncodeError
from typedcan.wire.receiver import Received

CODEC = SpokenCodec(PUMP, ["maker"])


class Idle(Participant):
    """Only its node lives."""

    name = "node"

    def step(self, now: float) -> None:
        pass

    @property
    def status(self) -> str:
        return ""


class Rig:
    """A panel and a pump that speak the edition, on a simulated wire that is overheard."""

    def __init__(self) -> None:
        clock = SimulatedClock()
        wire = SimulatedWire(clock)
        self.buses = [SimulatedBus(wire) for _ in range(3)]
        panel, pump, self.ear = self.buses
        self.panel = Node(PUMP, "Panel", panel, codec=CODEC, clock=clock)
        self.pump = Node(PUMP, "Pump", pump, codec=CODEC, clock=clock)
        self.world = World(Idle(self.panel), Idle(self.pump), clock=clock, wires=[wire])

    def frames(self, number: int) -> list[can.Message]:
        heard = iter(lambda: self.ear.recv(0), None)
        return [frame for frame in heard if frame.arbitration_id == number]


@pytest.fixture
def rig() -> Iterator[Rig]:
    made = Rig()
    yield made
    for bus in made.buses:
        bus.shutdown()


def command(**values: object) -> Any:
    usual = {"heat": code(Command, "heat", "On"), "speed": 100.0}
    return Command(**(usual | values))


def test_a_node_sends_with_the_edition_s_period_and_ends_with_its_safe_codes(rig: Rig) -> None:
    rig.panel.set(command())
    rig.world.run(1.0)
    frames = rig.frames(0x18FF0001)
    assert len(frames) in (50, 51)  # every 20 ms, not every 50 ms
    assert {frame.data[1] >> 6 for frame in frames} == {2}  # On, as the edition numbers it
    assert [frame.data[1] & 15 for frame in frames][:16] == [*range(1, 16), 1]
    assert [message.NAME for message in rig.panel.acting] == ["Command"]
    rig.panel.send_safe_codes()
    (last,) = rig.frames(0x18FF0001)
    assert last.data[1] >> 6 == 1  # Off there, and On in the words of the standard
    assert rig.panel.acting == ()


def test_a_node_that_makes_or_sends_messages_speaks_too(rig: Rig) -> None:
    rig.panel.supply(Command, lambda: [command(speed=50.0)])
    rig.world.run(0.1)
    assert {bytes(frame.data[2:4]) for frame in rig.frames(0x18FF0001)} == {b"\x00\xc8"}
    rig.panel.clear(Command)
    rig.frames(0x18FF0001)
    rig.world.run(0.1)
    assert rig.frames(0x18FF0001) == []
    rig.panel.send(command(speed=25.0))
    assert [bytes(frame.data[2:4]) for frame in rig.frames(0x18FF0001)] == [b"\x00\x64"]


def test_what_a_node_cannot_say_is_refused_when_it_is_set(rig: Rig) -> None:
    with pytest.raises(EncodeError, match="maker has no code for Wash"):
        rig.panel.set(command(mode=2))
    rig.world.run(0.2)
    assert rig.frames(0x18FF0001) == []


def test_callbacks_and_what_came_last_have_the_classes_of_the_program(rig: Rig) -> None:
    heard: list[Any] = []
    every: list[Any] = []
    rig.pump.on(Command, heard.append)
    rig.pump.on(Received, every.append)
    rig.panel.set(command())
    rig.world.run(0.1)
    assert heard
    assert {received.kind for received in [*heard, *every]} == {Command}
    last: Any = rig.pump.last(Command)
    assert last.message.heat is code(Command, "heat", "On")
    assert rig.pump.state(Command) is State.ALIVE
    assert rig.pump.counts.faults == 0


def test_events_of_supervision_have_them_and_their_meanings_too(rig: Rig) -> None:
    states: list[StateChanged | NotSeen] = []
    signals: list[SignalChanged] = []
    for kind in (StateChanged, NotSeen):
        rig.panel.on(kind, states.append)
    rig.pump.on(SignalChanged, signals.append)
    rig.panel.set(command(fault=code(Command, "fault", "Weld"), speed=100.0))
    rig.world.run(1.0)
    assert [event.message for event in states if event.message is Report] == [Report]
    told = {event.field: event.value for event in signals if event.message is Command}
    assert told["fault"] == code(Command, "fault", "Weld")
    only_there = [event.field for event in signals if event.message is not Command]
    assert only_there == ["extra"]
    assert "fault: alarm: Weld" in "\n".join(map(str, signals))


def test_a_message_of_the_edition_alone_is_expected_and_heard(rig: Rig) -> None:
    (cells,) = [kind for kind in CODEC.protocol.messages if kind.NAME == "Cells"]
    seen: list[Any] = []
    rig.panel.on(cells, lambda received: seen.append(received.message))
    make: Any = cells
    rig.pump.set(make(cell=7), Report(level=3))
    rig.world.run(0.5)
    assert {message.cell for message in seen} == {7}
    assert rig.panel.state(cells) is State.ALIVE


def test_streams_of_events_have_the_classes_of_the_program(rig: Rig) -> None:
    async def first(kind: Any = None) -> Any:
        stream = rig.pump.events(kind) if kind else rig.pump.events()
        rig.panel.send(command())
        rig.pump.turn()
        try:
            return await anext(stream)
        finally:
            await stream.aclose()

    assert asyncio.run(first(Command)).kind is Command
    assert asyncio.run(first()).kind is Command
