"""Time in a world: simulated or real, in one thread, and nothing is left behind."""

from __future__ import annotations

import itertools
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack
from functools import partial
from uuid import uuid4

import can
import pytest

from swapcan.nodes import world as line_world
from swapcan.nodes.bsu import Bsu
from swapcan.nodes.simulation import Simulation
from swapcan.nodes.tms import Tms
from typedcan.node.clock import SimulatedClock, SystemClock
from typedcan.simulate.participant import Participant, UnknownFaultError
from typedcan.simulate.simulated_bus import SimulatedBus, SimulatedWire
from typedcan.simulate.world import World


class Stopwatch(Participant):
    """Has no node, and notes when it is stepped."""

    name = "stopwatch"

    def __init__(self) -> None:
        super().__init__()
        self.times: list[float] = []

    def step(self, now: float) -> None:
        self.times.append(now)


@pytest.fixture
def clock() -> SimulatedClock:
    return SimulatedClock(100.0)


@pytest.fixture
def wire(clock: SimulatedClock) -> SimulatedWire:
    return SimulatedWire(clock)


@pytest.fixture
def stack() -> Iterator[ExitStack]:
    with ExitStack() as open_buses:
        yield open_buses


def test_participants_are_stepped_every_10_ms(clock: SimulatedClock) -> None:
    watch = Stopwatch()
    World(watch, clock=clock).run(1.0)
    assert len(watch.times) == 101
    assert watch.times[0] == 100.0
    assert watch.times[-1] == pytest.approx(101.0)
    gaps = [later - sooner for sooner, later in zip(watch.times, watch.times[1:], strict=False)]
    assert gaps == pytest.approx([0.01] * 100)


def test_steps_do_not_drift_however_long_it_runs(clock: SimulatedClock) -> None:
    watch = Stopwatch()
    world = World(watch, clock=clock)
    for _ in range(60):
        world.run(1.0)
    assert len(watch.times) == 6001
    assert watch.times[-1] == pytest.approx(160.0, abs=1e-9)


def test_running_twice_is_running_once_for_the_sum(clock: SimulatedClock) -> None:
    world = World(clock=clock)
    world.run(0.25)
    world.run(0.5)
    assert world.elapsed == 0.75
    assert clock.now() == 100.75


def test_actions_happen_at_their_times_in_order(clock: SimulatedClock) -> None:
    seen: list[tuple[str, float]] = []

    def note(name: str) -> None:
        seen.append((name, clock.now()))

    world = World(clock=clock)
    for name, moment in (("b", 0.505), ("c", 0.505), ("a", 0.1)):
        world.at(moment, partial(note, name))
    world.run(1.0)
    assert seen == [("a", 100.1), ("b", 100.505), ("c", 100.505)]


def test_an_action_after_the_end_waits_for_the_next_run(clock: SimulatedClock) -> None:
    seen: list[float] = []
    world = World(clock=clock)
    world.at(2.0, lambda: seen.append(clock.now()))
    world.run(1.5)
    assert seen == []
    world.run(1.0)
    assert seen == [102.0]


def test_messages_go_out_at_their_exact_times(
    clock: SimulatedClock, wire: SimulatedWire, stack: ExitStack
) -> None:
    listener = stack.enter_context(SimulatedBus(wire))
    bsu = Bsu(stack.enter_context(SimulatedBus(wire)), clock=clock)
    World(bsu, clock=clock, wires=[wire]).run(2.0)
    times = []
    while frame := listener.recv(0):
        times.append(frame.timestamp)
    gaps = [later - sooner for sooner, later in itertools.pairwise(times)]
    assert len(times) == 20
    assert gaps == pytest.approx([0.1] * 19, abs=1e-9)


def test_participants_of_one_world_share_a_line(
    clock: SimulatedClock, wire: SimulatedWire, stack: ExitStack
) -> None:
    tms = Tms(stack.enter_context(SimulatedBus(wire)), clock=clock)
    bsu = Bsu(stack.enter_context(SimulatedBus(wire)), clock=clock)
    world = line_world.World(tms, bsu, clock=clock)
    assert tms.line is bsu.line is world.line
    assert (world.line.load, world.line.charge) == (None, None)


def test_in_real_time_it_takes_the_time_it_is_given() -> None:
    watch = Stopwatch()
    world = World(watch, clock=SystemClock())
    began = time.perf_counter()
    world.run(0.2)
    took = time.perf_counter() - began
    assert 0.2 <= took < 0.3
    assert len(watch.times) >= 15


def test_with_a_world_it_lives_in_one_thread_that_ends(stack: ExitStack) -> None:
    channel = f"test-{uuid4()}"
    listener = stack.enter_context(can.Bus(channel, "virtual", ignore_config=True))
    bsu = Bsu(stack.enter_context(can.Bus(channel, "virtual", ignore_config=True)))
    before = set(threading.enumerate())
    with World(bsu) as world:
        assert len(set(threading.enumerate()) - before) == 1
        assert listener.recv(1.0) is not None
        with pytest.raises(RuntimeError, match="in a thread of its own"):
            world.run(1.0)
    assert set(threading.enumerate()) == before
    while listener.recv(0):
        pass
    assert listener.recv(0.15) is None


def test_what_goes_wrong_in_the_thread_is_raised_where_it_ends() -> None:
    world = World()
    happened = threading.Event()

    def fail() -> None:
        happened.set()
        raise ZeroDivisionError

    world.at(0.0, fail)
    with pytest.raises(ZeroDivisionError), world:
        assert happened.wait(5.0)


def test_a_fault_that_a_participant_does_not_know_is_refused(
    wire: SimulatedWire, stack: ExitStack
) -> None:
    tms = Tms(stack.enter_context(SimulatedBus(wire)))
    with pytest.raises(UnknownFaultError, match=r"^TMS has no fault 'rust'; it knows tms_fault$"):
        tms.inject("rust")
    tms.inject("tms_fault")
    assert tms.active_faults == {"tms_fault"}
    tms.heal("tms_fault")
    assert tms.active_faults == frozenset()


def test_a_simulation_that_cannot_begin_leaves_no_bus_open(wire: SimulatedWire) -> None:
    opened: list[SimulatedBus] = []

    def open_two() -> can.BusABC:
        if len(opened) == 2:
            raise can.CanInitializationError("no more channels")
        opened.append(SimulatedBus(wire))
        return opened[-1]

    with pytest.raises(can.CanInitializationError):
        Simulation(("BMU", "VCU", "BSU"), open_two)
    assert len(opened) == 2
    for bus in opened:
        with pytest.raises(can.CanOperationError, match="shut down"):
            bus.recv(0)
