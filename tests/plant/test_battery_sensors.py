"""What the sensors of a simulated pack measure, and which alarms follow."""

from __future__ import annotations

import dataclasses

import pytest

from swapcan.plant.alarms import FAULT_NUMBERS, Alarms, Faults
from swapcan.plant.battery import Battery, Layout
from swapcan.plant.sensors import Extreme, Measurement, Sensors
from typedcan.model.signal_state import SignalState


def measured(battery: Battery | None = None, *faults: str, seconds: float = 2.0) -> Measurement:
    """What is measured once faults have been there for so long."""
    sensors = Sensors(battery or Battery(soc=0.5))
    sensors.advance(seconds, faults)
    return sensors.measure(seconds, 0.0)


def number(value: float | SignalState) -> float:
    """A value that is one."""
    assert not isinstance(value, SignalState)
    return value


def test_the_readings_of_one_moment_agree() -> None:
    now = measured(Battery(Layout(cscs=3, cells=14, probes=4), soc=0.05))
    cells = [cell for csc in now.cells for cell in csc if isinstance(cell, float)]
    assert [len(csc) for csc in now.cells] == [14, 14, 14]
    assert [len(csc) for csc in now.probes] == [4, 4, 4]
    assert now.highest_cell.value == max(cells)
    assert now.lowest_cell.value == min(cells)
    assert isinstance(now.highest_cell.csc, int)
    assert now.cells[now.highest_cell.csc - 1][now.highest_cell.position - 1] == max(cells)
    assert now.voltage == pytest.approx(sum(cells))
    assert now.average_cell == pytest.approx(sum(cells) / 42, abs=0.0005)


def test_a_cell_without_a_reading_is_invalid_and_the_others_still_count() -> None:
    battery = Battery(soc=0.5)
    whole, failed = measured(battery), measured(battery, "sensor_failure")
    flat = [cell for csc in failed.cells for cell in csc]
    assert flat.count(SignalState.INVALID) == 1
    assert failed.voltage == whole.voltage
    assert isinstance(failed.lowest_cell.value, float)


def test_a_pack_whose_only_sensor_failed_measures_nothing() -> None:
    now = measured(Battery(Layout(cscs=1, cells=1)), "sensor_failure")
    assert now.highest_cell == Extreme(SignalState.INVALID, SignalState.INVALID, 0)
    assert now.average_cell is SignalState.INVALID


def test_overtemperature_comes_within_a_second_and_goes_within_another() -> None:
    sensors = Sensors(Battery(temperature=25.0))
    seen = []
    for faults in (("over_temperature",), ("over_temperature",), (), ()):
        sensors.advance(0.5, faults)
        seen.append(sensors.measure(0.0, 0.0).highest_probe.value)
    assert seen[1] == 62.0
    assert 40 < number(seen[0]) < 47
    assert 40 < number(seen[2]) < 47
    assert number(seen[3]) < 27


def test_the_discharge_limit_falls_with_the_state_of_charge() -> None:
    limits = [measured(Battery(soc=soc)).discharge_limit for soc in (0.5, 0.11, 0.02)]
    assert limits == pytest.approx([280.0, 140.0, 0.0])


def test_no_charge_is_allowed_into_a_full_or_a_frozen_battery() -> None:
    assert measured(Battery(soc=1.0)).charge_limit == 0
    assert measured(Battery(temperature=-2.0)).charge_limit == 0
    assert measured(Battery(soc=0.5)).charge_limit == pytest.approx(140.0)


def test_the_limits_fall_towards_60_degrees() -> None:
    limits = [measured(Battery(temperature=t)).discharge_limit for t in (30.0, 52.0, 62.0)]
    assert limits[0] > limits[1] > limits[2] == 0


def levels(now: Measurement) -> dict[str, int]:
    return Alarms().update(now)


@pytest.mark.parametrize("soc", [0.2, 0.5, 0.99])
def test_a_healthy_battery_raises_no_alarm(soc: float) -> None:
    assert levels(measured(Battery(soc=soc))) == {}


@pytest.mark.parametrize(
    ("fault", "field", "level"),
    [
        ("over_temperature", "flt_over_temp", 3),
        ("over_voltage_cell", "flt_over_ucell", 3),
        ("low_insulation", "flt_low_ins_res", 3),
        ("sensor_failure", "flt_hw", 2),
    ],
)
def test_each_fault_raises_its_alarm_as_the_gravest(fault: str, field: str, level: int) -> None:
    faults = Faults(levels(measured(None, fault)))
    assert faults.levels[field] == faults.level == level
    assert faults.code == FAULT_NUMBERS[field]


@pytest.mark.parametrize(("soc", "level"), [(0.20, 0), (0.14, 1), (0.07, 2), (0.02, 3)])
def test_low_charge_has_three_levels(soc: float, level: int) -> None:
    assert levels(measured(Battery(soc=soc))).get("flt_low_soc", 0) == level


@pytest.mark.parametrize(
    ("current", "field"), [(450.0, "flt_over_dis_chg"), (-240.0, "flt_over_chg")]
)
def test_too_much_current_is_an_alarm_of_level_2(current: float, field: str) -> None:
    now = dataclasses.replace(measured(), current=current)
    assert levels(now) == {field: 2}


def test_an_alarm_stays_until_the_value_is_well_below_where_it_began() -> None:
    alarms = Alarms()
    now = measured()
    seen = []
    for warmest in (49.0, 50.0, 49.0, 48.0, 47.0):
        hot = dataclasses.replace(
            now, highest_probe=Extreme(warmest, 1, 1), lowest_probe=Extreme(45.0, 1, 2)
        )
        seen.append(alarms.update(hot).get("flt_over_temp", 0))
    assert seen == [0, 1, 1, 1, 0]


def test_a_state_of_charge_that_jumps_is_an_alarm() -> None:
    alarms = Alarms()
    now = measured()
    assert alarms.update(now) == {}
    assert alarms.update(dataclasses.replace(now, soc=now.soc - 5)) == {"flt_soc_jump": 1}


def test_faults_are_numbered_as_the_rows_of_table_12() -> None:
    assert FAULT_NUMBERS["flt_del_temp"] == 1
    assert FAULT_NUMBERS["flt_fire"] == 21
    assert FAULT_NUMBERS["flt_main_pos_relay_weld"] == 22
    assert FAULT_NUMBERS["flt_chg_plug_ot"] == 44


def test_only_faults_that_gbt_32960_defines_are_counted() -> None:
    faults = Faults({"flt_over_temp": 1, "flt_low_temp": 2, "flt_main_pos_relay_weld": 3})
    assert faults.number == 1
    assert faults.level == 3


def test_what_charging_cures_does_not_forbid_it() -> None:
    assert not Faults({"flt_low_soc": 3, "flt_low_ucell": 3}).forbid_charging
    assert not Faults({"flt_over_temp": 1}).forbid_charging
    assert Faults({"flt_over_temp": 2}).forbid_charging
