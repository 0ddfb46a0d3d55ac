"""The battery of a simulated pack against calculations by hand."""

from __future__ import annotations

import pytest

from swapcan.plant.battery import Battery, Layout
from swapcan.plant.curves import interpolate


def run(
    battery: Battery, current: float, seconds: float, *, step: float = 0.1, coolant: float | None
) -> None:
    for _ in range(round(seconds / step)):
        battery.advance(step, current, coolant)


def test_a_hundred_ampere_for_36_seconds_take_one_ampere_hour() -> None:
    battery = Battery(Layout(capacity=200.0), soc=0.5)
    run(battery, 100.0, 36.0, coolant=None)
    assert battery.soc == pytest.approx(0.5 - 1 / 200)


def test_what_is_charged_raises_the_state_of_charge_by_as_much() -> None:
    battery = Battery(Layout(capacity=200.0), soc=0.5)
    run(battery, 100.0, 36.0, coolant=None)
    run(battery, -100.0, 36.0, coolant=None)
    assert battery.soc == pytest.approx(0.5)


def test_energy_is_voltage_times_current_times_time() -> None:
    battery = Battery(soc=0.6)
    discharged, charged = battery.discharged, battery.charged
    run(battery, 100.0, 36.0, coolant=None)
    # The curve is flat here: 100 A x 36 s x the voltage, 3.6 MJ to the kWh.
    assert battery.discharged - discharged == pytest.approx(
        100 * 36 * battery.voltage / 3.6e6, 1e-3
    )
    assert battery.charged == charged


def test_charging_counts_in_the_other_energy() -> None:
    battery = Battery(soc=0.6)
    discharged, charged = battery.discharged, battery.charged
    run(battery, -50.0, 72.0, coolant=None)
    assert battery.charged - charged == pytest.approx(50 * 72 * battery.voltage / 3.6e6, 1e-3)
    assert battery.discharged == discharged


def test_the_voltage_falls_by_current_times_inner_resistance() -> None:
    battery = Battery(Layout(capacity=280.0), soc=0.6, temperature=25.0)
    at_rest = battery.voltage
    battery.advance(0.001, 280.0)
    # 84 mohm of a cell of 1 Ah are 0.3 mohm at 280 Ah: 84 mV a cell at 1 C, 3 % from cell to cell.
    assert at_rest - battery.voltage == pytest.approx(24 * 0.084, rel=0.03)


def test_the_pack_has_the_voltage_of_all_its_cells() -> None:
    battery = Battery(Layout(cscs=18, cells=12), soc=0.5)
    assert len(battery.cells) == 216
    assert battery.voltage == pytest.approx(sum(battery.cells))
    assert battery.voltage == pytest.approx(216 * 3.29, abs=2)


def test_a_cold_battery_loses_more_voltage() -> None:
    warm, cold = Battery(soc=0.6, temperature=25.0), Battery(soc=0.6, temperature=0.0)
    losses = []
    for battery in (warm, cold):
        at_rest = battery.voltage
        battery.advance(0.001, 100.0)
        losses.append(at_rest - battery.voltage)
    assert losses[1] / losses[0] == pytest.approx(1.8, rel=0.01)


def test_losses_warm_the_cells() -> None:
    battery = Battery(Layout(capacity=280.0), soc=0.9, temperature=25.0)
    run(battery, 280.0, 60.0, coolant=None)
    # 280 A squared x 0.3 mohm x 60 s = 1411 J, into 19 x 280 J/K: 0.265 K.
    rise = sum(battery.temperatures) / len(battery.temperatures) - 25
    assert rise == pytest.approx(0.265, rel=0.03)


def test_cold_water_cools_and_warm_water_heats() -> None:
    hot, cold = Battery(temperature=40.0), Battery(temperature=0.0)
    run(hot, 0.0, 600.0, step=1.0, coolant=20.0)
    run(cold, 0.0, 600.0, step=1.0, coolant=35.0)
    assert max(hot.temperatures) < 36
    assert min(cold.temperatures) > 8
    assert min(hot.temperatures) > 20


def test_without_water_the_cells_keep_the_temperature_of_the_surroundings() -> None:
    battery = Battery(temperature=10.0)
    run(battery, 0.0, 600.0, step=1.0, coolant=None)
    assert battery.temperatures == pytest.approx([10.0] * 24)


def test_the_same_seed_gives_the_same_battery_and_another_one_another() -> None:
    one, same, other = (Battery(seed=seed, soc=0.05) for seed in (1, 1, 2))
    assert one.cells == same.cells
    assert one.cells != other.cells


def test_cells_differ_little_and_part_towards_the_empty_end() -> None:
    spreads = []
    for soc in (0.99, 0.5, 0.05):
        cells = Battery(soc=soc).cells
        spreads.append(max(cells) - min(cells))
    assert 0 < spreads[0] < 0.02
    assert 0 < spreads[1] < 0.02
    assert 0.01 < spreads[2] < 0.1


def test_balancing_takes_charge_from_the_higher_cells_only() -> None:
    battery = Battery(soc=0.02)
    before = battery.cells
    highest, lowest = before.index(max(before)), before.index(min(before))
    battery.balancing = True
    run(battery, 0.0, 3600.0, step=1.0, coolant=None)
    assert battery.cells[highest] < before[highest]
    assert battery.cells[lowest] == before[lowest]


def test_the_headroom_is_the_current_that_brings_the_first_cell_to_the_voltage() -> None:
    battery = Battery(soc=0.97)
    allowed = battery.headroom(3.6)
    battery.advance(0.001, -allowed)
    assert max(battery.cells) == pytest.approx(3.6, abs=0.001)


@pytest.mark.parametrize(
    ("wrong", "problem"),
    [
        ({"cscs": 19}, "cscs: expected 1 to 18, not 19"),
        ({"cells": 61}, "cells: expected 1 to 60, not 61"),
        ({"probes": 0}, "probes: expected 1 to 120, not 0"),
        ({"capacity": 0.0}, "capacity: expected 1 to 65534 Ah, not 0"),
    ],
)
def test_a_pack_that_the_frames_cannot_number_is_refused(
    wrong: dict[str, int], problem: str
) -> None:
    with pytest.raises(ValueError, match=problem):
        Layout(**wrong)


def test_between_two_points_a_curve_is_straight_and_outside_it_is_flat() -> None:
    points = ((0.0, 10.0), (2.0, 20.0))
    assert [interpolate(points, x) for x in (-1.0, 0.0, 0.5, 2.0, 3.0)] == [
        10.0,
        10.0,
        12.5,
        20.0,
        20.0,
    ]
