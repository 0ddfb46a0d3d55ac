"""The simulated truck, as the BMU sees it: clause 5.2 with tables 14 to 16."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import pytest
from nodes.outside import Outside, alone

from swapcan.messages import (
    B2V_RQ,
    B2V_ST0,
    B2V_ST1,
    B2V_ST2,
    B2V_ST3,
    V2B_CMD,
    V2B_VIN,
    B2V_BattInfo1,
    B2V_BattInfo2,
    BattInfoRequest,
    BmsState,
    FaultLevel,
    HvCommand,
    HvOffRequest,
    RelayState,
    SysCodeRequest,
    V2B_RQData,
    VinRequest,
)
from swapcan.nodes.vcu import VIN, Vcu
from swapcan.nodes.world import World
from swapcan.plant.driving import Motion, Power, shuttle
from swapcan.transfer import is_valid_vin, split_pack_code

Truck = tuple[Vcu, Outside, World]

CLOSED = B2V_ST1(bms=BmsState.HV_CLOSED)


@pytest.fixture
def truck() -> Iterator[Truck]:
    with alone(lambda bus, clock: Vcu(bus, clock=clock)) as all_three:
        yield all_three


def pack(outside: Outside, state: BmsState, *, discharge: float = 200.0) -> None:
    """Say what a healthy BMU in a state says."""
    outside.say(B2V_ST0())
    outside.say(B2V_ST1(bms=state))
    outside.say(B2V_ST2(soc=70.0, max_lmt_dis_chg_curr=discharge, max_lmt_chg_curr=50.0))
    outside.say(B2V_ST3(upack_batt=600.0, upack_out=600.0))


@pytest.fixture
def driving(truck: Truck) -> Truck:
    """A truck that drives at 30 km/h or more."""
    vcu, bmu, _ = truck
    pack(bmu, BmsState.HV_CLOSED)
    vcu.hv_on()
    vcu.drive()
    bmu.run(30.0)
    assert float(bmu.last(V2B_CMD).vehicle_speed) > 30.0
    assert vcu.load > 0
    return truck


def test_its_vin_has_a_right_check_digit() -> None:
    assert is_valid_vin(VIN)


def test_it_commands_every_50_ms_and_off_at_first(truck: Truck) -> None:
    _, bmu, _ = truck
    bmu.run(5.0)
    times = bmu.times(V2B_CMD)
    assert len(times) == 100
    assert times[-1] - times[0] == pytest.approx(99 * 0.05)
    assert {command.hv_on_off for command in bmu.all(V2B_CMD)} == {HvCommand.HV_OFF}
    assert bmu.faults == []


def test_it_tells_its_contactors_before_it_commands_high_voltage(truck: Truck) -> None:
    vcu, bmu, _ = truck
    pack(bmu, BmsState.HV_OPEN)
    bmu.run(1.0)
    assert bmu.last(V2B_CMD).main_motor_con_st == RelayState.OPEN
    vcu.hv_on()
    bmu.run(1.0)
    commands = [(each.main_motor_con_st, each.hv_on_off) for each in bmu.all(V2B_CMD)]
    first_on = next(place for place, (_, hv) in enumerate(commands) if hv == HvCommand.HV_ON)
    assert commands[first_on - 2 : first_on] == [(RelayState.CLOSED, HvCommand.HV_OFF)] * 2
    assert set(commands[first_on:]) == {(RelayState.CLOSED, HvCommand.HV_ON)}


def test_without_a_bmu_it_does_not_command_high_voltage(truck: Truck) -> None:
    vcu, bmu, _ = truck
    vcu.hv_on()
    bmu.run(3.0)
    assert {command.hv_on_off for command in bmu.all(V2B_CMD)} == {HvCommand.HV_OFF}


def test_it_gives_its_vin_when_asked_in_three_frames(truck: Truck) -> None:
    _, bmu, _ = truck
    bmu.run(1.0)
    assert bmu.all(V2B_VIN) == []
    bmu.say(B2V_RQ(vin=VinRequest.REQUEST_VIN, hv_off=HvOffRequest.NO_REQUEST_HV_OFF))
    bmu.run(1.0)
    frames = bmu.all(V2B_VIN)
    assert [frame.frame_no for frame in frames] == [1, 2, 3]
    fields = list(V2B_VIN.FIELDS)[1:]
    parts = [getattr(frame, name) for frame in frames for name in fields]
    assert "".join(part for part in parts if isinstance(part, str)) == VIN


def test_it_asks_for_pack_code_and_basic_data_and_withdraws_the_request(truck: Truck) -> None:
    vcu, bmu, _ = truck
    bmu.run(0.1)
    none = (
        BattInfoRequest.NOT_REQUEST_BATTINFO_DATA,
        SysCodeRequest.NOT_REQUEST_SYSCODE_DATA,
    )
    asked = [(each.rq_batt_info, each.rq_sys_code) for each in bmu.all(V2B_RQData)]
    assert asked == [none]
    vcu.ask()
    bmu.run(0.1)
    last = bmu.last(V2B_RQData)
    assert (last.rq_batt_info, last.rq_sys_code) == (
        BattInfoRequest.REQUEST_BATTINFO_DATA,
        SysCodeRequest.REQUEST_SYSCODE_DATA,
    )
    for message in split_pack_code("0DEPE280012SWAPR1A000025", 1):
        bmu.say(message)
    bmu.say(B2V_BattInfo1(rate_cap=280.0))
    bmu.say(B2V_BattInfo2(tot_csc_num=2, tot_cell_num=24))
    bmu.run(3.0)
    assert vcu.pack_code
    assert vcu.pack_code.result(0).text == "0DEPE280012SWAPR1A000025"
    assert vcu.battery_info
    assert vcu.battery_info.result(0).info1.rate_cap == 280.0
    last = bmu.last(V2B_RQData)
    assert (last.rq_batt_info, last.rq_sys_code) == none


def test_it_drives_within_the_limits_of_the_battery(truck: Truck) -> None:
    vcu, bmu, world = truck
    pack(bmu, BmsState.HV_CLOSED, discharge=80.0)
    vcu.hv_on()
    vcu.drive(profile=lambda elapsed: 60.0 if elapsed < 40 else 0.0)
    loads: list[float] = []
    world.after_each_step(lambda: loads.append(world.line.load or 0.0))
    bmu.run(60.0)
    assert 75.0 < max(loads) <= 80.0
    assert -50.0 <= min(loads) < -40.0
    assert vcu.motion.speed == 0.0


def test_a_worse_fault_halves_what_it_draws(truck: Truck) -> None:
    vcu, bmu, _ = truck
    pack(bmu, BmsState.HV_CLOSED, discharge=80.0)
    bmu.say(replace(CLOSED, fault_levl=FaultLevel.LEVEL_2_MORE_SEVERE_FAULT))
    vcu.hv_on()
    vcu.drive()
    loads = []
    for _ in range(30):
        bmu.run(0.5)
        loads.append(vcu.load)
    assert 38.0 < max(loads) <= 40.0


def test_it_draws_nothing_before_high_voltage_is_closed(truck: Truck) -> None:
    vcu, bmu, world = truck
    pack(bmu, BmsState.PRECHARGE)
    vcu.hv_on()
    vcu.drive(5.0)
    bmu.run(3.0)
    assert world.line.load == 0.0
    assert bmu.last(V2B_CMD).vehicle_speed == 0.0
    pack(bmu, BmsState.HV_CLOSED)
    bmu.run(4.0)
    assert float(bmu.last(V2B_CMD).vehicle_speed) > 0.0  # five seconds count from here


def test_a_drive_ends_after_its_time_and_high_voltage_stays(truck: Truck) -> None:
    vcu, bmu, _ = truck
    pack(bmu, BmsState.HV_CLOSED)
    vcu.hv_on()
    vcu.drive(10.0)
    bmu.run(9.0)
    assert vcu.status == "driving"
    bmu.run(20.0)
    assert vcu.status == "ready"
    last = bmu.last(V2B_CMD)
    assert (last.vehicle_speed, last.hv_on_off) == (0.0, HvCommand.HV_ON)


def test_high_voltage_goes_off_only_once_it_stands(driving: Truck) -> None:
    vcu, bmu, world = driving
    bmu.heard.clear()
    vcu.hv_off()
    bmu.run(30.0)
    commands = [(each.hv_on_off, float(each.vehicle_speed)) for each in bmu.all(V2B_CMD)]
    off = [speed for command, speed in commands if command == HvCommand.HV_OFF]
    assert off
    assert max(off) == 0.0
    assert world.line.load == 0.0
    assert bmu.last(V2B_CMD).main_motor_con_st == RelayState.OPEN


def test_a_request_for_high_voltage_off_is_obeyed_at_once(driving: Truck) -> None:
    vcu, bmu, world = driving
    bmu.heard.clear()
    bmu.say(B2V_RQ(vin=VinRequest.NO_REQUEST_VIN, hv_off=HvOffRequest.REQUEST_HV_OFF))
    bmu.run(0.1)
    assert bmu.last(V2B_CMD).hv_on_off == HvCommand.HV_OFF
    assert world.line.load == 0.0
    assert vcu.trouble == "the BMU asks for high voltage off"
    bmu.run(10.0)
    assert bmu.last(V2B_CMD).vehicle_speed == 0.0


@pytest.mark.parametrize("lost", [B2V_ST0, B2V_ST1])
def test_without_the_status_of_the_bmu_it_goes_to_its_safe_state_in_time(
    driving: Truck, lost: type[B2V_ST0 | B2V_ST1]
) -> None:
    vcu, bmu, world = driving
    bmu.hush(lost)
    bmu.run(0.4)
    assert bmu.last(V2B_CMD).hv_on_off == HvCommand.HV_ON
    bmu.run(0.25)
    assert bmu.last(V2B_CMD).hv_on_off == HvCommand.HV_OFF
    assert world.line.load == 0.0
    assert vcu.trouble == "the BMU is lost"
    bmu.run(10.0)
    assert bmu.last(V2B_CMD).vehicle_speed == 0.0


def test_it_stays_off_until_it_is_switched_on_again(driving: Truck) -> None:
    vcu, bmu, _ = driving
    bmu.hush(B2V_ST1)
    bmu.run(1.0)
    bmu.say(CLOSED)
    bmu.run(2.0)
    assert bmu.last(V2B_CMD).hv_on_off == HvCommand.HV_OFF
    vcu.hv_on()
    bmu.run(1.0)
    assert bmu.last(V2B_CMD).hv_on_off == HvCommand.HV_ON
    assert vcu.trouble == ""


@pytest.mark.parametrize(
    ("status", "trouble"),
    [
        (B2V_ST1(bms=BmsState.FAIL_TO_HV_ON), "the BMU cannot switch on"),
        (B2V_ST1(bms=BmsState.HV_OPEN), "the BMU has switched off"),
        (
            replace(CLOSED, fault_levl=FaultLevel.LEVEL3_MOST_SEVERE_FAULT),
            "the BMU reports a fault of level 3",
        ),
    ],
)
def test_what_the_bmu_reports_can_end_the_drive(
    driving: Truck, status: B2V_ST1, trouble: str
) -> None:
    vcu, bmu, _ = driving
    bmu.say(status)
    bmu.run(0.3)
    assert bmu.last(V2B_CMD).hv_on_off == HvCommand.HV_OFF
    assert vcu.status == f"off: {trouble}"


def test_it_remembers_the_states_of_the_bmu_in_their_order(truck: Truck) -> None:
    vcu, bmu, _ = truck
    for state in (BmsState.HV_OPEN, BmsState.PRECHARGE, BmsState.HV_CLOSED, BmsState.HV_OPEN):
        pack(bmu, state)
        bmu.run(0.5)
    assert vcu.states == [
        BmsState.HV_OPEN,
        BmsState.PRECHARGE,
        BmsState.HV_CLOSED,
        BmsState.HV_OPEN,
    ]


def test_energy_is_kept_while_it_drives() -> None:
    motion, out, back = Motion(), 0.0, 0.0
    limit = Power(out=400_000.0, back=200_000.0)
    for step in range(6000):
        power = motion.drive(0.01, shuttle(step / 100), limit)
        assert -limit.back <= power <= limit.out
        out += max(power, 0.0) * 0.01
        back += max(-power, 0.0) * 0.01
    kinetic = 0.5 * 42_000 * (50 / 3.6) ** 2
    assert out > kinetic / 0.9
    assert 0 < back < kinetic * 0.9
    assert motion.speed == 0.0
