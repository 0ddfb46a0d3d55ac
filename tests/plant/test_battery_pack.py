"""A simulated pack over a longer time than its messages are needed for."""

from __future__ import annotations

import itertools
from dataclasses import replace

import pytest

from swapcan.messages import BmsState, C2B_ACStatus, ChargeControl, ChargerOperation, ChargeState
from swapcan.plant.battery import Battery
from swapcan.plant.high_voltage import Command
from swapcan.plant.pack import Pack, Surroundings
from swapcan.plant.relays import Relay

CHARGE_RELAYS = {Relay.CHARGE_POSITIVE, Relay.CHARGE_NEGATIVE}


def run(
    pack: Pack, start: float, seconds: float, around: Surroundings, step: float = 0.01
) -> float:
    """Let time pass in the pack; the time that it is then."""
    for number in range(1, round(seconds / step) + 1):
        pack.step(start + number * step, around)
    return start + seconds


def test_what_flows_over_ten_minutes_is_what_the_state_of_charge_loses() -> None:
    pack = Pack(Battery(soc=0.8))
    around = Surroundings(command=Command.ON, load=0.0)
    now = run(pack, 0.0, 2.0, around)
    assert pack.status.state is BmsState.HV_CLOSED
    counted = 0.0
    for number in range(6000):
        load = 200.0 if number % 100 < 70 else -80.0
        pack.step(now + (number + 1) / 10, replace(around, load=load))
        counted += pack.status.measured.current * 0.1
    # 70 % of the time 200 A, 30 % of it -80 A: 116 A for 600 s are 19.3 of 280 Ah.
    assert counted / 3600 == pytest.approx(116 * 600 / 3600, rel=0.001)
    assert pack.status.measured.soc == pytest.approx(80 - 100 * counted / 3600 / 280, abs=1e-6)


def charger(pack: Pack, given: float) -> C2B_ACStatus:
    """A charger that does as it is told."""
    told = pack.status.charge
    on = told.control is ChargeControl.START_TO_CHARGE
    off = ChargerOperation.OFF_IN_ORDER_TO_PREVENT_BATTERY_REVERSE_CONNECTION
    return C2B_ACStatus(
        voltage_output=told.voltage if on else 0.0,
        current_output=given,
        charger_start=ChargerOperation.ON if on else off,
    )


def test_a_pack_is_charged_to_the_full_with_less_and_less_current() -> None:
    pack = Pack(Battery(soc=0.98))
    currents, highest, now = [], 0.0, 0.0
    while pack.status.charge.state is not ChargeState.END_OF_CHARGE:
        given = pack.status.charge.current
        now = run(
            pack, now, 0.5, Surroundings(charger=charger(pack, given), charge=given), step=0.1
        )
        currents.append(given)
        highest = max(highest, *pack.battery.cells)
        assert now < 3600
    assert pack.status.charge.control is ChargeControl.NORMAL_STOP_TO_CHARGE
    assert 100.0 <= pack.status.measured.soc < 100.1
    assert highest <= 3.601
    falling = currents[currents.index(max(currents)) :]
    assert all(later <= earlier + 0.1 for earlier, later in itertools.pairwise(falling))
    assert falling[0] > 3 * falling[-2] > 0
    # 5.6 Ah at some 3.42 V a cell.
    assert pack.status.charged_now == pytest.approx(5.6 * 24 * 3.42 / 1000, rel=0.03)
    run(pack, now, 1.0, Surroundings(charger=charger(pack, 0.0)))
    assert not pack.status.closed & CHARGE_RELAYS


def test_the_energy_of_a_charge_begins_anew_with_the_next_charger() -> None:
    pack = Pack(Battery(soc=0.5))
    now = 0.0
    for _ in range(40):
        around = Surroundings(charger=charger(pack, 60.0), charge=60.0)
        now = run(pack, now, 0.5, around, step=0.1)
    first = pack.status.charged_now
    # 60 A at 79 V for not quite 20 s.
    assert first == pytest.approx(60 * 79 * 20 / 3.6e6, rel=0.1)
    now = run(pack, now, 3.0, Surroundings(), step=0.1)
    assert pack.status.charged_now == pytest.approx(first, rel=0.1)
    run(pack, now, 0.3, Surroundings(charger=charger(pack, 0.0)))
    assert pack.status.charged_now == 0.0


def test_a_charger_is_not_joined_to_a_pack_that_is_welded() -> None:
    pack = Pack(Battery(soc=0.5))
    on = Surroundings(command=Command.ON, load=0.0, faults={"welded_relay"})
    now = run(pack, 0.0, 2.0, on)
    now = run(pack, now, 2.0, replace(on, command=Command.OFF))
    run(pack, now, 3.0, replace(on, command=Command.OFF, charger=charger(pack, 0.0)))
    assert pack.status.closed == {Relay.MAIN_POSITIVE}
    assert pack.status.charge.state is ChargeState.CHARGE_ERROR
    assert pack.status.charge.control is ChargeControl.FAULT_STOP_TO_CHARGE
