"""A pack that was switched off sleeps (5.2.1.4), says nothing, and is woken."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from swapcan.messages import BmsState
from swapcan.simulate import Simulation, plan_of, planned_fault
from typedcan.simulate.simulated_bus import SimulatedBus
from typedcan.wire.acting import acts

PLAN = "hv_on@0.5s, hv_off@3s"


class Rig:
    """A truck and a pack that may sleep, with the times of the pack's frames."""

    def __init__(self, *nodes: str, plan: str = PLAN, may_sleep: bool = True) -> None:
        self.simulation = Simulation.simulated(nodes, plan=plan_of(plan))
        assert self.simulation.bmu
        self.bmu = self.simulation.bmu
        self.bmu.may_sleep = may_sleep
        self.world = self.simulation.world
        self._ears = [SimulatedBus(wire) for wire in self.simulation.wires]

    def heard(self) -> list[tuple[float, int, bytes]]:
        """What the pack has sent since the last call."""
        sent = {kind.FRAME_ID for kind in self.bmu.protocol.sent_by("BMU")}
        frames = [frame for ear in self._ears for frame in iter(lambda ear=ear: ear.recv(0), None)]  # type: ignore[misc]
        return [
            (frame.timestamp, frame.arbitration_id, bytes(frame.data))
            for frame in frames
            if frame.arbitration_id in sent
        ]

    def close(self) -> None:
        self.simulation.close()
        for ear in self._ears:
            ear.shutdown()


@pytest.fixture
def rig() -> Iterator[Rig]:
    made = Rig("BMU", "VCU", "TMS")
    yield made
    made.close()


def test_once_it_is_off_a_pack_saves_its_data_for_three_seconds_and_is_silent(rig: Rig) -> None:
    rig.world.run(4.0)
    assert rig.bmu.state.state is BmsState.HV_OPEN
    rig.heard()
    rig.world.run(5.0)
    times = [time for time, *_ in rig.heard()]
    assert rig.bmu.status == "asleep"
    assert 6.0 < max(times) < 6.5
    rig.world.run(5.0)
    assert rig.heard() == []  # though the truck still says off


def test_before_it_sleeps_it_takes_back_what_it_has_commanded(rig: Rig) -> None:
    rig.world.run(10.0)
    last = {number: data for _, number, data in rig.heard()}
    decoded = [rig.simulation.codec.decode(number, data) for number, data in last.items()]
    assert any(message.NAME == "BMS_TMS_0" for message in decoded)
    assert not any(acts(message) for message in decoded)
    assert rig.bmu.node.acting == ()


def test_a_truck_that_is_to_have_high_voltage_wakes_it_and_gets_it(rig: Rig) -> None:
    rig.world.run(10.0)
    rig.heard()
    vcu = rig.simulation.vcu
    assert vcu
    vcu.hv_on()
    rig.world.run(3.0)
    assert min(time for time, *_ in rig.heard()) < 10.3
    assert (rig.bmu.state.state, vcu.trouble) == (BmsState.HV_CLOSED, "")
    vcu.hv_off()
    rig.world.run(6.0)
    assert rig.bmu.status == "asleep"


def test_a_truck_that_speaks_again_after_silence_wakes_it_until_it_was_on_and_off_again() -> None:
    rig = Rig("BMU", "VCU")
    rig.world.run(10.0)
    silent = planned_fault("VCU.bus_silence@0s")
    rig.simulation.inject(silent)
    rig.world.run(1.5)
    assert rig.bmu.status == "asleep"
    rig.simulation.heal(silent)
    rig.world.run(8.0)
    assert rig.bmu.status == "HV open"
    rig.close()


def test_a_charger_wakes_it() -> None:
    rig = Rig("BMU", "VCU", "CHG", plan="hv_on@0.5s, hv_off@3s, charge@12s+3s")
    rig.world.run(11.0)
    assert rig.bmu.status == "asleep"
    rig.heard()
    rig.world.run(3.0)
    times = [time for time, *_ in rig.heard()]
    assert 12.0 < min(times) < 13.0
    assert rig.bmu.status != "asleep"
    rig.close()


def test_a_pack_that_may_not_sleep_stays_awake() -> None:
    rig = Rig("BMU", "VCU", may_sleep=False)
    rig.world.run(12.0)
    times = [time for time, *_ in rig.heard()]
    assert max(times) > 11.9
    rig.close()


def test_a_pack_that_nobody_has_switched_off_does_not_sleep() -> None:
    rig = Rig("BMU", plan="")
    rig.world.run(12.0)
    assert rig.bmu.status != "asleep"
    rig.close()
