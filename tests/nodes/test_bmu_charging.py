"""The simulated pack and a charger: tables 18 and 19 of 5.3 and 5.4, rows 11 to 13 of table 1."""

from __future__ import annotations

from dataclasses import replace

import pytest
from nodes.bmu_talk import Pack
from nodes.outside import Outside

from swapcan.messages import (
    B2V_ST0,
    B2V_ST1,
    B2V_ST2,
    BMS_TMS_0,
    V2B_CMD,
    B2C_Charger,
    BmsState,
    C2B_ACStatus,
    ChargeControl,
    ChargeLine,
    ChargeMode,
    ChargerFault,
    ChargerOperation,
    ChargerTimeout,
    ChargeState,
    HvCommand,
    RelayState,
)
from typedcan.model.signal_state import SignalState

VOLTAGE = 79.9  # of the resting pack at its first state of charge
IDLE = C2B_ACStatus(
    voltage_output=0.0,
    current_output=0.0,
    charger_start=ChargerOperation.OFF_IN_ORDER_TO_PREVENT_BATTERY_REVERSE_CONNECTION,
)
READY = C2B_ACStatus(voltage_output=VOLTAGE, current_output=0.0, charger_start=ChargerOperation.ON)
GIVING = replace(READY, voltage_output=86.4, current_output=60.0)


@pytest.fixture
def charging(pack: Pack) -> Pack:
    """A pack that is being charged with 60 A."""
    _, chg, _ = pack
    chg.say(READY)
    chg.run(1.5)
    chg.say(GIVING)
    chg.run(1.5)
    assert chg.last(B2V_ST1).chg_st is ChargeState.CHARGING
    return pack


def number(value: float | SignalState) -> float:
    """A value that is one."""
    assert not isinstance(value, SignalState)
    return value


def charge_relays(chg: Outside) -> tuple[RelayState | int, RelayState | int]:
    """Charge positive and negative."""
    last = chg.last(B2V_ST0)
    return last.st_chg_pos1, last.st_chg_neg1


def test_without_a_charger_it_says_stop_with_no_current(pack: Pack) -> None:
    _, chg, _ = pack
    chg.run(3.0)
    stop = B2C_Charger(
        voltage_set=0.0, current_set=0.0, charge_control=ChargeControl.NORMAL_STOP_TO_CHARGE
    )
    assert set(chg.all(B2C_Charger)) == {stop}
    last = chg.last(B2V_ST1)
    assert last.chg_line is ChargeLine.NOT_CONNECTED
    assert last.chg_mode is ChargeMode.RESERVED
    assert last.chg_st is ChargeState.READY_TO_BE_CHARGING


def test_the_positive_charge_relay_waits_for_the_charger_to_have_the_packs_voltage(
    pack: Pack,
) -> None:
    _, chg, _ = pack
    chg.say(IDLE)
    chg.run(3.0)
    asked = chg.last(B2C_Charger)
    assert asked.charge_control is ChargeControl.START_TO_CHARGE
    assert asked.voltage_set == pytest.approx(VOLTAGE, abs=0.1)
    assert asked.current_set == 0.0
    assert charge_relays(chg) == (RelayState.OPEN, RelayState.CLOSED)
    assert chg.last(B2V_ST1).chg_st is ChargeState.READY_TO_BE_CHARGING
    chg.say(replace(READY, voltage_output=VOLTAGE * 1.08))
    chg.run(2.0)
    assert charge_relays(chg) == (RelayState.OPEN, RelayState.CLOSED)
    chg.say(READY)
    chg.run(1.5)
    assert charge_relays(chg) == (RelayState.CLOSED, RelayState.CLOSED)


def test_charging_is_told_to_all_who_care(charging: Pack) -> None:
    _, chg, _ = charging
    chg.run(1.0)
    status, asked = chg.last(B2V_ST1), chg.last(B2C_Charger)
    assert status.chg_line is ChargeLine.CONNECTED
    assert status.chg_mode is ChargeMode.AC_CHARGING
    assert status.bms is BmsState.HV_OPEN
    assert chg.last(BMS_TMS_0).chrg_sts is ChargeState.CHARGING
    # 24 cells to 3.6 V; half the capacity of 280 Ah in an hour.
    assert asked.voltage_set == pytest.approx(86.4)
    assert asked.current_set == pytest.approx(140.0)
    assert asked.charge_control is ChargeControl.START_TO_CHARGE
    assert chg.last(B2V_ST2).current == pytest.approx(-60.0)


@pytest.mark.parametrize(
    "fault",
    [
        replace(GIVING, charger_hardware=ChargerFault.FAULT),
        replace(GIVING, charger_input_voltage=ChargerFault.FAULT),
        replace(GIVING, charger_can=ChargerTimeout.FAULT_OVERTIME),
    ],
)
def test_a_fault_of_the_charger_stops_charging_until_it_is_gone(
    charging: Pack, fault: C2B_ACStatus
) -> None:
    _, chg, _ = charging
    chg.say(replace(fault, current_output=0.0))
    chg.run(1.5)
    assert chg.last(B2C_Charger).charge_control is ChargeControl.FAULT_STOP_TO_CHARGE
    assert chg.last(B2C_Charger).current_set == 0.0
    assert chg.last(B2V_ST1).chg_st is ChargeState.CHARGE_ERROR
    assert charge_relays(chg) == (RelayState.OPEN, RelayState.OPEN)
    chg.say(READY)
    chg.run(2.0)
    assert chg.last(B2V_ST1).chg_st is ChargeState.CHARGING


def test_a_hot_charger_is_asked_for_half_the_current(charging: Pack) -> None:
    _, chg, _ = charging
    chg.say(replace(GIVING, charger_over_temp=ChargerFault.FAULT))
    chg.run(2.0)
    assert chg.last(B2C_Charger).current_set == pytest.approx(70.0)
    chg.say(GIVING)
    chg.run(2.0)
    assert chg.last(B2C_Charger).current_set == pytest.approx(140.0)


def test_a_charger_that_is_not_ready_is_not_started(pack: Pack) -> None:
    _, chg, _ = pack
    chg.say(replace(READY, charger_ready=ChargerTimeout.FAULT_OVERTIME))
    chg.run(3.0)
    assert chg.last(B2C_Charger).charge_control is ChargeControl.NORMAL_STOP_TO_CHARGE
    assert charge_relays(chg) == (RelayState.OPEN, RelayState.OPEN)


def test_a_charger_that_falls_silent_ends_charging(charging: Pack) -> None:
    _, chg, _ = charging
    chg.hush(C2B_ACStatus)
    chg.run(5.0)
    assert chg.last(B2C_Charger).charge_control is ChargeControl.NORMAL_STOP_TO_CHARGE
    assert chg.last(B2V_ST1).chg_line is ChargeLine.NOT_CONNECTED
    assert charge_relays(chg) == (RelayState.OPEN, RelayState.OPEN)
    assert chg.last(B2V_ST2).current == 0.0


def test_a_truck_that_moves_is_not_charged(pack: Pack) -> None:
    _, others, _ = pack
    others.say(V2B_CMD(hv_on_off=HvCommand.HV_ON, vehicle_speed=5.0))
    others.run(0.2)
    others.say(READY)
    others.run(3.0)
    assert others.last(B2C_Charger).charge_control is ChargeControl.NORMAL_STOP_TO_CHARGE
    assert charge_relays(others) == (RelayState.OPEN, RelayState.OPEN)


def test_charging_that_is_not_wanted_does_not_begin(pack: Pack) -> None:
    bmu, chg, _ = pack
    bmu.may_charge = False
    chg.say(READY)
    chg.run(3.0)
    assert chg.last(B2C_Charger).charge_control is ChargeControl.NORMAL_STOP_TO_CHARGE


def test_a_fault_of_the_pack_stops_charging_until_it_is_gone(charging: Pack) -> None:
    bmu, chg, _ = charging
    bmu.inject("low_insulation")
    chg.say(READY)
    chg.run(3.0)
    assert chg.last(B2C_Charger).charge_control is ChargeControl.FAULT_STOP_TO_CHARGE
    assert charge_relays(chg) == (RelayState.OPEN, RelayState.OPEN)
    bmu.heal("low_insulation")
    chg.run(4.0)
    assert chg.last(B2V_ST1).chg_st is ChargeState.CHARGING


def test_charging_goes_on_beside_high_voltage(charging: Pack) -> None:
    _, others, _ = charging
    others.say(V2B_CMD(hv_on_off=HvCommand.HV_ON, vehicle_speed=0.0))
    others.run(3.0)
    assert others.last(B2V_ST1).bms is BmsState.HV_CLOSED
    assert others.last(B2V_ST1).chg_st is ChargeState.CHARGING
    # What stands draws 2.8 A, a hundredth of the capacity.
    assert number(others.last(B2V_ST2).current) == pytest.approx(-57.2, abs=0.2)
