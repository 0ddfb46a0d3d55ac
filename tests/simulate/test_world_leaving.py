"""A world in real time ends what its participants have commanded."""

from __future__ import annotations

import threading

import can
import pytest
from node.rough_bus import (
    PATIENCE,
    Hang,
    RoughBus,
    frames_until,
    is_off,
    is_on,
    made_rough,
    raising,
    rest,
    trailing_offs,
)

from swapcan import StillActingError
from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import V2B_CMD, HvCommand
from swapcan.node import Node
from typedcan.node import leaving
from typedcan.node.clock import Clock, SimulatedClock, SystemClock
from typedcan.simulate import world as world_module
from typedcan.simulate.participant import Participant
from typedcan.simulate.simulated_bus import SimulatedBus, SimulatedWire
from typedcan.simulate.world import World


class Driver(Participant):
    """Commands high voltage on from the beginning."""

    name = "VCU"

    def __init__(self, bus: can.BusABC, clock: Clock) -> None:
        self.node = Node(PROTOCOL, "VCU", bus, clock=clock)
        super().__init__(self.node)
        self.node.set(V2B_CMD(hv_on_off=HvCommand.HV_ON))

    def step(self, now: float) -> None:
        pass


@pytest.fixture
def rough(near: can.BusABC) -> RoughBus:
    return made_rough(near)


@pytest.fixture
def driver(rough: RoughBus) -> Driver:
    return Driver(rough, SystemClock())


def test_off_is_the_last_word(driver: Driver, far: can.BusABC) -> None:
    with World(driver):
        heard = frames_until(far, is_on)
    assert len(trailing_offs(heard + rest(far))) == 5
    assert driver.node.acting == ()


@pytest.mark.parametrize("error", [ZeroDivisionError, KeyboardInterrupt])
def test_a_world_that_cannot_go_on_ends_it_at_once(
    driver: Driver, far: can.BusABC, error: type[BaseException]
) -> None:
    heard: list[can.Message] = []

    def live() -> None:
        with World(driver) as world:
            heard.extend(frames_until(far, is_on))
            world.at(0.0, raising(error))
            heard.extend(frames_until(far, is_off))

    with pytest.raises(error):
        live()
    assert len(trailing_offs(heard + rest(far))) == 5


def test_a_bus_that_takes_nothing_any_more_is_said_to_be_live(
    driver: Driver, rough: RoughBus, far: can.BusABC
) -> None:
    def live() -> None:
        with World(driver):
            frames_until(far, is_on)
            rough.before_send = raising(OSError)

    with pytest.raises(StillActingError, match="TAKE IT FOR LIVE") as raised:
        live()
    assert raised.value.messages == ("V2B_CMD",)
    assert isinstance(raised.value.__cause__, OSError)


def test_off_is_the_last_word_where_sending_fails_at_first(
    driver: Driver, rough: RoughBus, far: can.BusABC
) -> None:
    with World(driver):
        heard = frames_until(far, is_on)
        rough.before_send = raising(OSError, times=7)
    assert len(trailing_offs(heard + rest(far))) == 5
    assert driver.node.acting == ()


@pytest.mark.parametrize("place", ["sending", "waiting"])
def test_ctrl_c_while_a_world_is_left_comes_after_the_safe_codes(
    driver: Driver,
    rough: RoughBus,
    far: can.BusABC,
    place: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    interrupt = raising(KeyboardInterrupt, times=1)

    def live() -> list[can.Message]:
        with World(driver):
            heard = frames_until(far, is_on)
            if place == "sending":
                rough.before_send = interrupt
            else:
                monkeypatch.setattr("typedcan.node.leaving.time.sleep", interrupt)
        return heard

    if place == "waiting":
        with pytest.raises(KeyboardInterrupt):
            live()
    else:
        live()
    assert len(rest_of(far)) >= 5
    assert driver.node.acting == ()


def rest_of(bus: can.BusABC) -> list[can.Message]:
    """The commands for off since the last one for on, whatever their counters."""
    frames = rest(bus)
    on = [number for number, frame in enumerate(frames) if is_on(frame)]
    return frames[on[-1] + 1 if on else 0 :]


def test_a_world_that_hangs_in_a_bus_is_left_all_the_same(
    driver: Driver, rough: RoughBus, far: can.BusABC, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in (world_module, leaving):
        monkeypatch.setattr(module, "_PATIENCE", 0.2)
    hang, hangs = Hang(), threading.Event()

    def begin_to_hang(_: can.Message) -> None:
        hangs.set()
        hang()

    def live() -> None:
        with World(driver):
            frames_until(far, is_on)
            rough.before_send = begin_to_hang
            assert hangs.wait(PATIENCE)

    try:
        with pytest.raises(StillActingError, match="the bus hangs") as raised:
            live()
    finally:
        hang.release()
    assert raised.value.messages == ("V2B_CMD",)


def test_an_error_that_the_block_is_left_with_stays_and_gets_a_note(
    driver: Driver, rough: RoughBus, far: can.BusABC
) -> None:
    def live() -> None:
        with World(driver):
            frames_until(far, is_on)
            rough.before_send = raising(OSError)
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError) as raised:
        live()
    assert "TAKE IT FOR LIVE" in raised.value.__notes__[0]


def test_in_simulated_time_there_is_nothing_to_end() -> None:
    clock = SimulatedClock()
    wire = SimulatedWire(clock)
    with SimulatedBus(wire) as bus, SimulatedBus(wire) as heard:
        world = World(Driver(bus, clock), clock=clock, wires=(wire,))
        with world:
            pass
        world.run(1.0)
        assert all(map(is_on, rest(heard)))
