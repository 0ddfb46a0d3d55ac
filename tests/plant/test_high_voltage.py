"""The high-voltage sequence: order of relays and states, failures, welds, requests unheard."""

from __future__ import annotations

import dataclasses
import itertools
import math

import pytest
from plant.high_voltage_rig import VOLTAGE, Rig

from swapcan.messages import BmsState
from swapcan.plant.bus_bar import BusBar
from swapcan.plant.high_voltage import Command
from swapcan.plant.relays import Relay, Relays

ON = [
    "main negative closes",
    "precharge closes",
    "main positive closes",
    "precharge opens",
]
OFF = ["main positive opens", "main negative opens"]


def switched_on() -> Rig:
    rig = Rig()
    rig.command(Command.ON, 2.0)
    assert rig.state() is BmsState.HV_CLOSED
    rig.seen.clear()
    rig.states.clear()
    return rig


def test_switching_on_goes_through_precharge_in_the_right_order() -> None:
    rig = Rig()
    rig.run(0.5)
    rig.command(Command.ON, 2.0)
    assert rig.order == ON
    assert rig.states == [BmsState.HV_OPEN, BmsState.PRECHARGE, BmsState.HV_CLOSED]


def test_nothing_switches_before_it_is_commanded() -> None:
    rig = Rig()
    rig.run(5.0)
    rig.command(Command.OFF, 5.0)
    assert rig.order == []
    assert rig.states == [BmsState.HV_OPEN]


def test_the_precharge_takes_as_long_as_resistor_and_capacitors_take() -> None:
    rig = Rig()
    rig.command(Command.ON, 2.0)
    # 25 ohm x 10 mF = 0.25 s; 95 % after 0.25 s x ln 20 = 0.749 s, then 20 ms for the relay.
    took = rig.first_closed(Relay.MAIN_POSITIVE) - rig.first_closed(Relay.PRECHARGE)
    assert took == pytest.approx(0.25 * math.log(20) + 0.02, abs=0.02)


def test_each_relay_takes_20_ms_and_no_two_switch_at_once() -> None:
    rig = Rig()
    rig.command(Command.ON, 2.0)
    rig.command(Command.OFF, 3.0)
    times = [seen.change.at for seen in rig.seen]
    assert len(times) == 6
    assert all(later - earlier >= 0.02 - 1e-9 for earlier, later in itertools.pairwise(times))


def test_switching_off_opens_main_positive_then_main_negative() -> None:
    rig = switched_on()
    rig.command(Command.OFF, 2.0)
    assert rig.order == OFF
    assert rig.states == [BmsState.HV_CLOSED, BmsState.HV_OPEN]


def test_the_bus_bar_goes_down_when_the_relays_are_open() -> None:
    rig = switched_on()
    assert rig.bus_bar.voltage == VOLTAGE
    rig.command(Command.OFF, 4.0)
    assert rig.bus_bar.voltage < 1


@pytest.mark.parametrize(("current", "at"), [(9.0, 0.05), (-9.0, 0.05), (200.0, 2.05)])
def test_the_relay_opens_once_the_current_is_gone_or_after_two_seconds(
    current: float, at: float
) -> None:
    rig = switched_on()
    rig.set(current=current)
    began = rig.now
    rig.command(Command.OFF, 3.0)
    assert rig.seen[0].change.relay is Relay.MAIN_POSITIVE
    assert rig.seen[0].change.at - began == pytest.approx(at, abs=0.03)


def test_a_shorted_load_lets_the_precharge_fail_after_three_seconds() -> None:
    rig = Rig()
    rig.bus_bar.shorted = True
    rig.command(Command.ON, 5.0)
    assert rig.order == [*ON[:2], "precharge opens", "main negative opens"]
    assert rig.states == [BmsState.PRECHARGE, BmsState.FAIL_TO_HV_ON]
    assert rig.seen[2].change.at - rig.seen[1].change.at == pytest.approx(3.0, abs=0.05)


def test_a_failure_lasts_until_off_is_commanded_and_then_on_works() -> None:
    rig = Rig()
    rig.bus_bar.shorted = True
    rig.command(Command.ON, 5.0)
    rig.bus_bar.shorted = False
    rig.command(Command.ON, 5.0)
    assert rig.state() is BmsState.FAIL_TO_HV_ON
    rig.command(Command.OFF, 0.1)
    assert rig.state() is BmsState.HV_OPEN
    rig.command(Command.ON, 2.0)
    assert rig.state() is BmsState.HV_CLOSED


def test_off_during_precharge_opens_all() -> None:
    rig = Rig()
    rig.command(Command.ON, 0.4)
    rig.command(Command.OFF, 1.0)
    assert rig.order == [*ON[:2], "precharge opens", "main negative opens"]
    assert rig.states == [BmsState.PRECHARGE, BmsState.HV_OPEN]


def test_off_while_main_positive_closes_opens_precharge_first_and_finds_no_weld() -> None:
    rig = Rig()
    rig.command(Command.ON)
    while not rig.relays.is_commanded(Relay.MAIN_POSITIVE):
        rig.run(0.01)
    rig.command(Command.OFF, 2.0)
    assert rig.order == [*ON[:3], "precharge opens", *OFF]
    assert rig.relays.weld_faults == set()


def test_a_precharge_is_broken_off_when_the_command_is_lost() -> None:
    rig = Rig()
    rig.command(Command.ON, 0.4)
    rig.command(Command.NONE, 1.0)
    assert rig.state() is BmsState.HV_OPEN
    assert rig.relays.closed == frozenset()


def test_high_voltage_stays_for_ten_seconds_without_a_command() -> None:
    rig = switched_on()
    rig.command(Command.NONE, 9.5)
    assert rig.order == []
    rig.run(1.5)
    assert rig.order == OFF


def test_a_welded_main_positive_is_found_shown_closed_and_not_closed_upon() -> None:
    rig = switched_on()
    rig.relays.stuck_closed.add(Relay.MAIN_POSITIVE)
    rig.command(Command.OFF, 2.0)
    assert rig.order == ["main negative opens"]
    assert rig.relays.closed == {Relay.MAIN_POSITIVE}
    assert rig.relays.weld_faults == {Relay.MAIN_POSITIVE}
    rig.command(Command.ON, 5.0)
    assert rig.order == ["main negative opens"]
    assert rig.state() is BmsState.FAIL_TO_HV_ON


def test_a_weld_is_over_a_second_after_the_relay_has_opened() -> None:
    rig = switched_on()
    rig.relays.stuck_closed.add(Relay.MAIN_POSITIVE)
    rig.command(Command.OFF, 2.0)
    rig.relays.stuck_closed.clear()
    rig.run(0.5)
    assert rig.order == ["main negative opens", "main positive opens"]
    assert rig.relays.weld_faults
    rig.run(1.0)
    assert not rig.relays.weld_faults
    rig.command(Command.ON, 2.0)
    assert rig.state() is BmsState.HV_CLOSED


def test_a_relay_that_opens_as_it_should_is_not_taken_for_welded() -> None:
    rig = switched_on()
    rig.command(Command.OFF, 2.0)
    assert rig.relays.weld_faults == set()


@pytest.mark.parametrize("relay", [Relay.MAIN_NEGATIVE, Relay.PRECHARGE, Relay.MAIN_POSITIVE])
def test_a_relay_that_cannot_close_is_reported_and_all_open_again(relay: Relay) -> None:
    rig = Rig()
    rig.relays.stuck_open.add(relay)
    rig.command(Command.ON, 3.0)
    assert rig.relays.open_faults == {relay}
    assert rig.relays.closed == frozenset()
    assert rig.states[-1] is BmsState.FAIL_TO_HV_ON
    assert BmsState.HV_CLOSED not in rig.states


def test_the_fault_of_a_relay_that_could_not_close_is_gone_when_it_closes() -> None:
    rig = Rig()
    rig.relays.stuck_open.add(Relay.MAIN_POSITIVE)
    rig.command(Command.ON, 3.0)
    rig.relays.stuck_open.clear()
    rig.command(Command.OFF, 0.5)
    rig.command(Command.ON, 2.0)
    assert rig.relays.open_faults == set()
    assert rig.state() is BmsState.HV_CLOSED


def test_a_pack_whose_request_is_not_heard_opens_by_itself_after_five_seconds() -> None:
    rig = switched_on()
    rig.set(fault=True)
    rig.command(Command.ON, 4.9)
    assert rig.order == []
    rig.run(0.5)
    assert rig.order == OFF
    assert rig.machine.self_opened


def test_a_pack_that_opened_by_itself_stays_open_until_off_and_on_are_commanded() -> None:
    rig = switched_on()
    rig.set(fault=True)
    rig.run(6.0)
    rig.set(fault=False)
    rig.command(Command.ON, 5.0)
    assert rig.state() is BmsState.HV_OPEN
    rig.command(Command.OFF, 0.1)
    assert not rig.machine.self_opened
    rig.command(Command.ON, 2.0)
    assert rig.state() is BmsState.HV_CLOSED


def test_a_fault_that_passes_in_time_changes_nothing() -> None:
    rig = switched_on()
    for _ in range(3):
        rig.set(fault=True)
        rig.run(4.0)
        rig.set(fault=False)
        rig.run(1.0)
    assert rig.order == []


def test_with_a_grave_fault_high_voltage_cannot_be_switched_on() -> None:
    rig = Rig()
    rig.set(fault=True)
    rig.command(Command.ON, 2.0)
    assert rig.order == []
    assert rig.state() is BmsState.FAIL_TO_HV_ON


def test_the_accessory_relay_follows_its_command_while_there_is_high_voltage() -> None:
    rig = switched_on()
    rig.demand = dataclasses.replace(rig.demand, accessory=True)
    rig.run(1.0)
    assert rig.relays.is_closed(Relay.ACCESSORY)
    rig.command(Command.OFF, 2.0)
    assert rig.order == ["accessory closes", "accessory opens", *OFF]


def test_the_charge_relays_close_and_open_beside_the_main_ones() -> None:
    rig = Rig()
    rig.charge = True
    rig.command(Command.ON, 2.0)
    assert rig.path.is_closed
    assert rig.state() is BmsState.HV_CLOSED
    rig.charge = False
    rig.run(1.0)
    assert rig.order[-2:] == ["charge positive 1 opens", "charge negative 1 opens"]


def test_a_charge_relay_that_cannot_close_is_not_tried_again_while_charging_is_wanted() -> None:
    rig = Rig()
    rig.charge = True
    rig.relays.stuck_open.add(Relay.CHARGE_POSITIVE)
    rig.run(5.0)
    assert rig.path.failed
    assert rig.order == ["charge negative 1 closes", "charge negative 1 opens"]
    rig.relays.stuck_open.clear()
    rig.charge = False
    rig.run(1.0)
    rig.charge = True
    rig.run(1.0)
    assert rig.path.is_closed


def test_relays_refuse_a_command_while_another_one_switches() -> None:
    relays = Relays()
    relays.command(Relay.PRECHARGE, closed=True, now=0.0)
    with pytest.raises(RuntimeError, match="main negative cannot switch while precharge does"):
        relays.command(Relay.MAIN_NEGATIVE, closed=True, now=0.01)


def test_without_a_connection_the_bus_bar_discharges_with_its_time_constant() -> None:
    bus_bar = BusBar()
    bus_bar.voltage = 80.0
    for _ in range(50):
        bus_bar.advance(0.01, 80.0, Relays())
    assert bus_bar.voltage == pytest.approx(80 / math.e)
