"""A simulation in real time that is left ends what its nodes command, or says that it could not."""

from __future__ import annotations

from collections.abc import Callable

import can
import pytest
from node.rough_bus import RoughBus, made_rough, raising, rest, trailing_offs

from swapcan import StillActingError
from swapcan.nodes.plan import plan_of
from swapcan.nodes.simulation import Simulation


@pytest.fixture
def rough(near: can.BusABC) -> RoughBus:
    return made_rough(near)


@pytest.fixture
def simulation(rough: RoughBus, far: can.BusABC) -> Simulation:
    """A truck that has commanded high voltage on, beside a pack that is there."""
    buses = iter((far, rough))  # the pack's comes first
    simulation = Simulation(["VCU", "BMU"], lambda: next(buses), plan=plan_of("hv_on@0s"))
    assert simulation.vcu
    vcu = simulation.vcu
    simulation.world.after_each_step(lambda: None)
    while not vcu.node.acting:
        simulation.world.run(0.1)
    return simulation


def test_off_is_the_last_word(simulation: Simulation, open_bus: Callable[..., can.BusABC]) -> None:
    listener = open_bus()
    simulation.close()
    assert len(trailing_offs(rest(listener))) == 5


def test_a_bus_that_takes_nothing_any_more_is_said_to_be_live(
    simulation: Simulation, rough: RoughBus
) -> None:
    rough.before_send = raising(lambda: OSError("Network is down"))
    with pytest.raises(StillActingError, match=r"Network is down.*TAKE IT FOR LIVE") as raised:
        simulation.close()
    assert raised.value.messages == ("V2B_CMD",)
    with pytest.raises(can.CanError):  # closed all the same
        rough.recv(0)


def test_it_is_told_beside_the_error_that_the_block_is_left_with(
    simulation: Simulation, rough: RoughBus, caplog: pytest.LogCaptureFixture
) -> None:
    rough.before_send = raising(OSError)
    with pytest.raises(ZeroDivisionError) as raised, simulation:
        raise ZeroDivisionError
    (said,) = raised.value.__notes__
    assert said.startswith("the simulation: the safe codes of V2B_CMD could not be sent")
    assert said in caplog.messages
    with pytest.raises(can.CanError):
        rough.recv(0)
