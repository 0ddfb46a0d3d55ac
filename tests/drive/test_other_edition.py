"""Driving where editions disagree: what is left, and what ends it once another one is heard."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

import can
import pytest
from spoken.editions import PUMP, Command, code

from typedcan.drive.departure import Departure
from typedcan.drive.driving import Driving, Left
from typedcan.drive.noting_bus import NotingBus, OtherEditionError
from typedcan.node.clock import SimulatedClock
from typedcan.node.node import Node
from typedcan.simulate.participant import Participant
from typedcan.simulate.simulated_bus import SimulatedBus, SimulatedWire
from typedcan.simulate.world import World
from typedcan.spoken.codec import SpokenCodec
from typedcan.wire.codec import Codec

CELLS, LAMP = 0x18FF0003, 0x18FF0004
"""Which only the edition called maker has, and only the one called third."""


class Panel(Participant):
    """Heats."""

    name = "Panel"

    def step(self, now: float) -> None:
        pass


class Rig:
    """A panel that drives, and somebody else who is heard and hears."""

    def __init__(self, stack: ExitStack, *names: str) -> None:
        self.codec = SpokenCodec(PUMP, names) if names else Codec(PUMP)
        self.clock = SimulatedClock()
        self.wire = SimulatedWire(self.clock)
        self.far = SimulatedBus(self.wire)
        lent = SimulatedBus(self.wire)
        played = [kind for kind in self.codec.protocol.messages if kind.NAME == "Command"]
        self.bus = NotingBus(lent, self.codec, lambda _: None, clock=self.clock, played=played)
        for each in (self.far, lent, self.bus):
            stack.callback(each.shutdown)
        self.panel = Panel(Node(PUMP, "Panel", self.bus, codec=self.codec, clock=self.clock))
        self.world = World(self.panel, clock=self.clock, wires=[self.wire])
        self.driving = Driving([self.bus], clock=self.clock, wires=(self.wire,))

    def heat(self) -> None:
        command: Any = Command(heat=code(Command, "heat", "On"), speed=1.0)
        self.panel.nodes[0].set(command)

    def says(self, number: int) -> None:
        self.far.send(can.Message(arbitration_id=number, data=b"\0"))

    def heats(self) -> list[int]:
        """The raw values of Heat on the wire so far, where the edition has the signal."""
        heard = iter(lambda: self.far.recv(0), None)
        frames = [frame for frame in heard if frame.arbitration_id == Command.FRAME_ID]
        shift = 6 if "maker" in self.codec.protocol.model.chosen else 4
        return [frame.data[1] >> shift & 3 for frame in frames]

    def leave(self) -> Left:
        return self.driving.leave(Departure(stand_still=[self.panel], are_off=lambda: True))


@pytest.fixture
def stack() -> Iterator[ExitStack]:
    with ExitStack() as opened:
        yield opened


@pytest.mark.parametrize(
    ("names", "on", "safe"), [((), 1, 3), (("third",), 1, 2), (("maker",), 2, 1)]
)
def test_what_is_left_is_the_edition_s_safe_code_or_invalid_where_none_was_chosen(
    stack: ExitStack, names: tuple[str, ...], on: int, safe: int
) -> None:
    rig = Rig(stack, *names)
    rig.heat()
    rig.driving.live(rig.world, 0.5)
    assert set(rig.heats()) == {on}
    assert rig.leave() is Left.SAFE
    assert set(rig.heats()) == {safe}
    assert rig.bus.acting == ()


@pytest.mark.parametrize(
    ("names", "sign", "said"),
    [
        ((), CELLS, "edition maker is spoken on the bus: it alone has 0x18FF0003"),
        ((), LAMP, "nothing that acts is sent as the usual edition has it"),
        (("third",), CELLS, "nothing that acts is sent as third has it"),
        (("maker",), LAMP, "edition third is spoken on the bus: it alone has 0x18FF0004"),
    ],
)
def test_nothing_is_driven_where_another_edition_is_heard_before(
    stack: ExitStack, names: tuple[str, ...], sign: int, said: str
) -> None:
    rig = Rig(stack, *names)
    rig.says(sign)
    with pytest.raises(OtherEditionError, match=said):
        rig.driving.look_out()
    rig.heat()
    with pytest.raises(OtherEditionError):
        rig.driving.live(rig.world, 0.5)
    assert rig.heats() == []


@pytest.mark.parametrize(("names", "on"), [((), 1), (("third",), 1)])
def test_driving_ends_with_no_valid_value_where_another_edition_is_heard_later(
    stack: ExitStack, names: tuple[str, ...], on: int
) -> None:
    rig = Rig(stack, *names)
    rig.heat()
    rig.world.at(0.3, lambda: rig.says(CELLS))
    with pytest.raises(OtherEditionError):
        rig.driving.live(rig.world, 5.0)
    assert rig.clock.now() < 0.5
    assert set(rig.heats()) == {on}
    assert rig.leave() is Left.SAFE
    assert set(rig.heats()) == {3}


def test_the_chosen_edition_s_own_messages_are_no_sign(stack: ExitStack) -> None:
    rig = Rig(stack, "maker")
    rig.says(CELLS)
    rig.driving.look_out()
    rig.heat()
    rig.driving.live(rig.world, 0.5)
    assert set(rig.heats()) == {2}


def test_where_nothing_is_driven_another_edition_is_no_trouble(stack: ExitStack) -> None:
    rig = Rig(stack)
    rig.bus.played = ()
    rig.says(CELLS)
    rig.driving.live(rig.world, 0.5)
    assert rig.bus.other_edition is not None
