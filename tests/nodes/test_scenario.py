"""High voltage on, drive, charge, off: on the simulated clock, as seen on the wire."""

from __future__ import annotations

import subprocess
import sys

import pytest
from commands.running import environment
from nodes.wire_log import WireLog

from swapcan.messages import BmsState, ChargeState, HvCommand
from swapcan.nodes.bmu import Bmu
from swapcan.nodes.chg import Chg
from swapcan.nodes.plan import plan_of
from swapcan.nodes.simulation import Simulation
from swapcan.nodes.vcu import Vcu
from swapcan.nodes.world import World
from typedcan.node.clock import SimulatedClock
from typedcan.simulate.simulated_bus import SimulatedBus, SimulatedWire

PLAN = "hv_on@0.5s, ask@1s, drive@2s+8s, charge@14s+6s, hv_off@21s"


def frames_of(
    seed: int, seconds: float, *, nodes: tuple[str, ...]
) -> list[tuple[float, int, bytes]]:
    """Every frame of a simulation on one wire: second, identifier, bytes."""
    clock = SimulatedClock()
    wire = SimulatedWire(clock)
    with (
        SimulatedBus(wire) as listener,
        Simulation(
            nodes,
            lambda: SimulatedBus(wire),
            plan=[step for step in plan_of(PLAN) if step.node in nodes],
            clock=clock,
            wires=(wire,),
            seed=seed,
        ) as simulation,
    ):
        simulation.world.run(seconds)
        frames = []
        while frame := listener.recv(0):
            frames.append((frame.timestamp, frame.arbitration_id, bytes(frame.data)))
        return frames


@pytest.fixture(scope="module")
def log() -> WireLog:
    """The whole scenario, with all participants on one wire."""
    clock = SimulatedClock()
    wire = SimulatedWire(clock)
    with (
        SimulatedBus(wire) as listener,
        Simulation(
            ("BMU", "VCU", "CHG", "TMS", "BSU"),
            lambda: SimulatedBus(wire),
            plan=plan_of(PLAN),
            clock=clock,
            wires=(wire,),
        ) as simulation,
    ):
        simulation.world.run(24.0)
        log = WireLog()
        while frame := listener.recv(0):
            log.take(frame)
        assert simulation.bmu
        assert simulation.vcu
        assert simulation.bmu.vin == "LDEMTRCK0R0000025"
        assert simulation.vcu.pack_code
        assert len(simulation.vcu.pack_code.result(0).text) == 24
        assert simulation.vcu.trouble == ""
        return log


def test_the_states_follow_each_other(log: WireLog) -> None:
    assert log.commands == [HvCommand.HV_OFF, HvCommand.HV_ON, HvCommand.HV_OFF]
    assert log.states == [
        BmsState.HV_OPEN,
        BmsState.PRECHARGE,
        BmsState.HV_CLOSED,
        BmsState.HV_OPEN,
    ]


def test_no_relay_closes_or_opens_in_the_wrong_order(log: WireLog) -> None:
    log.check_relays()
    everything = frozenset[str]().union(*log.relays)
    assert everything == {"st_main_neg", "st_prechg", "st_main_pos", "st_chg_neg1", "st_chg_pos1"}
    assert log.relays[0] == log.relays[-1] == frozenset()


def test_the_bus_bar_is_precharged_before_the_main_positive_relay_closes(log: WireLog) -> None:
    risen = next(
        place for place, (inside, outside) in enumerate(log.voltages) if outside > 0.9 * inside
    )
    assert 0 < risen < len(log.voltages)
    assert all(outside < 0.9 * inside for inside, outside in log.voltages[:risen])


def test_the_truck_drives_and_stands_while_it_is_charged(log: WireLog) -> None:
    assert max(log.speeds) > 5.0
    assert log.speeds[-1] == 0.0
    assert ChargeState.CHARGING in log.charge_states
    assert log.charge_states[-1] == ChargeState.READY_TO_BE_CHARGING


def test_nothing_is_wrong_with_any_frame(log: WireLog) -> None:
    assert log.faults == []
    # B2V_ST0 to 6, 24 cells and 12 probes, V2B_CMD, BSU_BMS_0
    assert log.frames > 24 * (70 + 80 + 10 + 20 + 10)


def test_charge_flows_out_and_in_as_the_pack_counts_it() -> None:
    clock = SimulatedClock()
    vehicle, charger = SimulatedWire(clock), SimulatedWire(clock)
    with (
        SimulatedBus(vehicle) as one,
        SimulatedBus(vehicle) as two,
        SimulatedBus(charger) as three,
        SimulatedBus(charger) as four,
    ):
        bmu = Bmu(one, clock=clock, charger=three)
        vcu = Vcu(two, clock=clock)
        chg = Chg(four, clock=clock, connected=False)
        world = World(bmu, vcu, chg, clock=clock, wires=[vehicle, charger])
        flows: list[float] = []
        world.after_each_step(
            lambda: flows.append(((world.line.load or 0.0) - (world.line.charge or 0.0)) * 0.01)
        )
        vcu.hv_on()
        world.run(2.0)
        before = bmu.pack.battery.soc
        flows.clear()
        vcu.drive(10.0)
        world.run(15.0)
        driven = bmu.pack.battery.soc
        assert driven < before
        chg.connect()
        world.run(15.0)
        assert bmu.pack.battery.soc > driven
        change = (before - bmu.pack.battery.soc) * bmu.pack.battery.layout.capacity
        assert change == pytest.approx(sum(flows) / 3600, abs=0.01)


def test_the_same_seed_gives_the_same_bytes_at_the_same_times() -> None:
    nodes = ("BMU", "VCU", "CHG", "TMS", "BSU")
    first = frames_of(7, 6.0, nodes=nodes)
    assert len(first) > 1000
    assert frames_of(7, 6.0, nodes=nodes) == first


def test_another_process_gives_the_same_bytes_too() -> None:
    digest = (
        "import hashlib; from nodes.test_scenario import frames_of;"
        "frames = frames_of(3, 3.0, nodes=('BMU', 'VCU', 'CHG', 'TMS', 'BSU'));"
        "print(hashlib.sha256(repr(frames).encode()).hexdigest())"
    )
    answers = []
    for hash_seed in ("1", "2"):
        done = subprocess.run(
            [sys.executable, "-c", digest],
            env=environment() | {"PYTHONHASHSEED": hash_seed},
            capture_output=True,
            encoding="utf-8",
            check=True,
        )
        answers.append(done.stdout)
    assert len(answers[0]) == 65
    assert answers[0] == answers[1]


def test_another_seed_gives_another_pack() -> None:
    assert frames_of(1, 1.0, nodes=("BMU",)) != frames_of(2, 1.0, nodes=("BMU",))
