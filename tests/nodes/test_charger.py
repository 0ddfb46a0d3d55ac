"""The simulated charger, as the BMU sees it: tables 18 and 19 of 5.3 and 5.4."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace

import pytest
from nodes.outside import Outside, alone

from swapcan.messages import (
    B2C_Charger,
    C2B_ACStatus,
    ChargeControl,
    ChargerFault,
    ChargerOperation,
    ChargerTimeout,
)
from swapcan.nodes.chg import Chg
from swapcan.nodes.world import World

GO = B2C_Charger(voltage_set=80.0, current_set=100.0, charge_control=ChargeControl.START_TO_CHARGE)
STOP = replace(GO, charge_control=ChargeControl.NORMAL_STOP_TO_CHARGE)
OFF = ChargerOperation.OFF_IN_ORDER_TO_PREVENT_BATTERY_REVERSE_CONNECTION

Charger = tuple[Chg, Outside, World]


@pytest.fixture
def charger() -> Iterator[Charger]:
    with alone(lambda bus, clock: Chg(bus, clock=clock)) as all_three:
        yield all_three


@pytest.fixture
def charging(charger: Charger) -> Charger:
    """A charger that gives what it is asked for."""
    _, bmu, _ = charger
    bmu.say(GO)
    bmu.run(5.0)
    assert bmu.last(C2B_ACStatus).current_output == 100.0
    return charger


def test_it_reports_every_500_ms_after_its_self_test(charger: Charger) -> None:
    _, bmu, _ = charger
    bmu.say(STOP)
    bmu.run(10.2)
    times = bmu.times(C2B_ACStatus)
    assert times[0] >= 0.5
    assert [round(b - a, 6) for a, b in itertools.pairwise(times)] == [0.5] * (len(times) - 1)
    assert len(times) in (19, 20)
    assert bmu.last(C2B_ACStatus) == C2B_ACStatus(
        voltage_output=0.0,
        current_output=0.0,
        charger_hardware=ChargerFault.OK,
        charger_over_temp=ChargerFault.OK,
        charger_input_voltage=ChargerFault.OK,
        charger_ready=ChargerTimeout.NORMAL,
        charger_start=OFF,
        charger_can=ChargerTimeout.NORMAL,
    )


def test_it_rises_to_the_set_points_with_a_ramp(charger: Charger) -> None:
    _, bmu, world = charger
    bmu.say(GO)
    bmu.run(6.0)
    currents = [float(status.current_output) for status in bmu.all(C2B_ACStatus)]
    assert currents == sorted(currents)
    assert max(b - a for a, b in itertools.pairwise(currents)) <= 26.0
    assert currents[-1] == 100.0
    last = bmu.last(C2B_ACStatus)
    assert (last.voltage_output, last.charger_start) == (80.0, ChargerOperation.ON)
    assert world.line.charge == 100.0


def test_it_follows_a_lower_set_point(charging: Charger) -> None:
    _, bmu, world = charging
    bmu.say(replace(GO, current_set=20.0))
    bmu.run(1.2)
    assert bmu.last(C2B_ACStatus).current_output == 20.0
    assert world.line.charge == 20.0


@pytest.mark.parametrize(
    "control", [ChargeControl.NORMAL_STOP_TO_CHARGE, ChargeControl.FAULT_STOP_TO_CHARGE]
)
def test_it_stops_when_the_bmu_says_so(charging: Charger, control: ChargeControl) -> None:
    _, bmu, world = charging
    bmu.say(replace(GO, charge_control=control))
    bmu.run(1.2)
    last = bmu.last(C2B_ACStatus)
    assert (last.current_output, last.voltage_output, last.charger_start) == (0.0, 0.0, OFF)
    assert world.line.charge == 0.0


def test_without_the_bmu_it_stops_within_five_periods_and_says_why(charging: Charger) -> None:
    _, bmu, world = charging
    bmu.hush(B2C_Charger)
    bmu.run(3.1)
    last = bmu.last(C2B_ACStatus)
    assert last.charger_can == ChargerTimeout.FAULT_OVERTIME
    assert (last.current_output, last.charger_start) == (0.0, OFF)
    assert world.line.charge == 0.0


def test_it_charges_again_once_the_bmu_is_back(charging: Charger) -> None:
    _, bmu, _ = charging
    bmu.hush(B2C_Charger)
    bmu.run(4.0)
    bmu.say(GO)
    bmu.run(5.0)
    last = bmu.last(C2B_ACStatus)
    assert (last.charger_can, last.current_output) == (ChargerTimeout.NORMAL, 100.0)


def test_a_bmu_that_never_speaks_is_a_communication_fault(charger: Charger) -> None:
    _, bmu, _ = charger
    bmu.run(4.0)
    assert bmu.last(C2B_ACStatus).charger_can == ChargerTimeout.FAULT_OVERTIME


@pytest.mark.parametrize(
    ("fault", "field"),
    [("charger_hardware", "charger_hardware"), ("charger_input_voltage", "charger_input_voltage")],
)
def test_a_fault_that_ends_charging_ends_it_and_lets_it_begin_again(
    charging: Charger, fault: str, field: str
) -> None:
    chg, bmu, world = charging
    chg.inject(fault)
    bmu.run(1.0)
    last = bmu.last(C2B_ACStatus)
    assert getattr(last, field) == ChargerFault.FAULT
    assert (last.current_output, last.charger_start) == (0.0, OFF)
    assert world.line.charge == 0.0
    chg.heal(fault)
    bmu.run(4.0)
    last = bmu.last(C2B_ACStatus)
    assert getattr(last, field) == ChargerFault.OK
    assert last.current_output == 100.0


def test_too_hot_it_says_so_and_gives_less(charging: Charger) -> None:
    chg, bmu, _ = charging
    bmu.say(replace(GO, current_set=300.0))
    bmu.run(6.0)
    assert bmu.last(C2B_ACStatus).current_output == 300.0
    chg.inject("charger_over_temperature")
    bmu.run(1.0)
    last = bmu.last(C2B_ACStatus)
    assert last.charger_over_temp == ChargerFault.FAULT
    assert 0 < float(last.current_output) <= 150.0


def test_taken_off_the_truck_it_is_silent(charging: Charger) -> None:
    chg, bmu, world = charging
    chg.disconnect()
    bmu.run(0.1)
    bmu.heard.clear()
    bmu.run(3.0)
    assert bmu.all(C2B_ACStatus) == []
    assert world.line.charge == 0.0
    assert not chg.connected


def test_it_can_be_connected_later() -> None:
    with alone(lambda bus, clock: Chg(bus, clock=clock, connected=False)) as (chg, bmu, _):
        bmu.say(STOP)
        bmu.run(3.0)
        assert bmu.heard == []
        chg.connect()
        bmu.run(1.2)
        assert bmu.last(C2B_ACStatus).charger_can == ChargerTimeout.NORMAL
