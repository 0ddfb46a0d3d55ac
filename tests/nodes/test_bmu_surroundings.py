"""The simulated pack between truck, cooling unit, two buses and a clock."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from nodes.bmu_talk import OFF, ON, Pack, number
from nodes.outside import Outside, alone

from swapcan.messages import (
    B2V_ST0,
    B2V_ST2,
    BMS_TMS_0,
    TMS_BMS_0,
    B2C_Charger,
    C2B_ACStatus,
    ChargerOperation,
    FaultFlag,
    HvRelayState,
    HvRequest,
    ThermalMode,
    WarningLevel,
)
from swapcan.nodes.bmu import Bmu
from swapcan.nodes.world import World
from swapcan.plant.battery import Battery
from typedcan.node.clock import SimulatedClock
from typedcan.simulate.simulated_bus import SimulatedBus, SimulatedWire


def test_the_truck_draws_more_the_faster_it_drives_but_never_more_than_allowed(
    closed: Pack,
) -> None:
    _, vcu, _ = closed
    drawn = []
    for speed in (0.0, 40.0, 80.0):
        vcu.say(replace(ON, vehicle_speed=speed))
        vcu.run(8.0)
        drawn.append(number(vcu.last(B2V_ST2).current))
        assert drawn[-1] <= number(vcu.last(B2V_ST2).max_lmt_dis_chg_curr)
    assert 0 < drawn[0] < drawn[1] < drawn[2]
    vcu.say(replace(ON, vehicle_speed=40.0))
    vcu.run(1.0)
    assert number(vcu.last(B2V_ST2).current) < 0


def test_without_high_voltage_no_current_flows(pack: Pack) -> None:
    _, vcu, _ = pack
    vcu.say(replace(OFF, vehicle_speed=50.0))
    vcu.run(3.0)
    assert {message.current for message in vcu.all(B2V_ST2)} == {0.0}


WATER = TMS_BMS_0(
    work_sts=ThermalMode.COOLING,
    hv_rly_sts=HvRelayState.CLOSED,
    output_water_temp=15.0,
    input_water_temp=20.0,
)


def test_a_warm_pack_asks_for_cooling_and_for_power_only_with_high_voltage() -> None:
    with alone(lambda bus, clock: Bmu(bus, clock=clock, battery=Battery(temperature=36.0))) as (
        _,
        others,
        _,
    ):
        others.run(2.0)
        asked = others.last(BMS_TMS_0)
        assert asked.reqst_set_tms_sts is ThermalMode.COOLING
        assert asked.reqst_tms_hv_on is HvRequest.REQUEST_HV_OFF
        assert asked.hv_rly_sts is HvRelayState.OPEN
        others.say(ON)
        others.run(4.0)
        asked = others.last(BMS_TMS_0)
        assert asked.reqst_tms_hv_on is HvRequest.REQUEST_HV_ON
        assert asked.hv_rly_sts is HvRelayState.CLOSED
        assert asked.set_temp == 20.0
        assert asked.volt == pytest.approx(79.9, abs=1)


def test_a_cold_pack_asks_for_heating() -> None:
    with alone(lambda bus, clock: Bmu(bus, clock=clock, battery=Battery(temperature=3.0))) as (
        _,
        others,
        _,
    ):
        others.run(2.0)
        assert others.last(BMS_TMS_0).reqst_set_tms_sts is ThermalMode.HEATING


def test_cold_water_cools_the_cells() -> None:
    with alone(lambda bus, clock: Bmu(bus, clock=clock, battery=Battery(temperature=36.0))) as (
        bmu,
        others,
        _,
    ):
        others.say(WATER)
        others.run(20.0)
        # 19 J/K over 0.012 W/K make 1583 s: after 20 s 1.26 % of 21 K are gone.
        warmth = sum(bmu.pack.battery.temperatures) / 24
        assert warmth == pytest.approx(36 - 21 * 0.0126, abs=0.03)


def test_a_faulty_cooling_unit_is_reported(pack: Pack) -> None:
    _, others, _ = pack
    others.say(replace(WATER, fault_lv=WarningLevel.LEVEL_2))
    others.run(2.0)
    assert others.last(B2V_ST0).flt_tms_system is FaultFlag.FAULT
    others.say(WATER)
    others.run(2.0)
    assert others.last(B2V_ST0).flt_tms_system is FaultFlag.NORMAL


def frames(seed: int) -> list[tuple[float, int, bytes]]:
    """All frames of a pack in ten seconds with high voltage and a fault."""
    clock = SimulatedClock()
    wire = SimulatedWire(clock)
    seen = []
    with SimulatedBus(wire) as bus, SimulatedBus(wire) as other:
        bmu = Bmu(bus, clock=clock, seed=seed)
        outside = Outside(World(bmu, clock=clock, wires=[wire]), other)
        outside.say(replace(ON, vehicle_speed=30.0))
        with SimulatedBus(wire) as tap:
            outside.run(5.0)
            bmu.inject("over_voltage_cell")
            outside.run(5.0)
            while frame := tap.recv(0):
                seen.append((frame.timestamp, frame.arbitration_id, bytes(frame.data)))
    return seen


def test_the_same_seed_gives_the_same_frames_and_another_seed_others() -> None:
    first = frames(1)
    assert len(first) > 1500
    assert first == frames(1)
    assert first != frames(2)


def test_on_two_buses_each_message_is_on_the_bus_of_its_receiver() -> None:
    clock = SimulatedClock()
    vehicle, charger = SimulatedWire(clock), SimulatedWire(clock)
    with (
        SimulatedBus(vehicle) as bus,
        SimulatedBus(vehicle) as vcu_bus,
        SimulatedBus(charger) as charger_bus,
        SimulatedBus(charger) as chg_bus,
    ):
        bmu = Bmu(bus, clock=clock, charger=charger_bus)
        world = World(bmu, clock=clock, wires=[vehicle, charger])
        vcu, chg = Outside(world, vcu_bus), Outside(world, chg_bus)
        vcu.say(ON)
        chg.say(C2B_ACStatus(charger_start=ChargerOperation.ON))
        vcu.run(1.0)
        chg.run(1.0)
        assert {type(message) for _, message in chg.heard} == {B2C_Charger}
        assert vcu.heard
        assert not vcu.all(B2C_Charger)
        expected = [
            {message.name for message in node.snapshot().messages if message.expected}
            for node in bmu.nodes
        ]
        assert expected == [{"V2B_CMD", "TMS_BMS_0", "BSU_BMS_0"}, {"C2B_ACStatus"}]


def test_a_pack_that_was_left_alone_for_a_while_catches_up(pack: Pack) -> None:
    bmu, vcu, _ = pack
    vcu.run(0.1)
    before = bmu.pack.battery.soc
    bmu.step(3600.0)
    assert bmu.pack.battery.soc == before
    assert math.isclose(bmu.state.measured.at, 3600.0, abs_tol=11)
