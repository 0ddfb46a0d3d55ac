"""The simulated cooling unit, as the BMU sees it: table 20 of 5.6, as table 19 of 5.5 asks."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import pytest
from nodes.outside import Outside, alone

from swapcan.messages import (
    BMS_TMS_0,
    TMS_BMS_0,
    HvRelayState,
    HvRequest,
    ThermalMode,
    WarningLevel,
)
from swapcan.nodes.tms import Tms
from swapcan.nodes.world import World

COOL = BMS_TMS_0(
    reqst_set_tms_sts=ThermalMode.COOLING,
    reqst_tms_hv_on=HvRequest.REQUEST_HV_ON,
    hv_rly_sts=HvRelayState.CLOSED,
    volt=77.0,
    set_temp=15.0,
)

Unit = tuple[Tms, Outside, World]


@pytest.fixture
def unit() -> Iterator[Unit]:
    with alone(lambda bus, clock: Tms(bus, clock=clock)) as all_three:
        yield all_three


def test_it_reports_every_second_and_is_off_at_first(unit: Unit) -> None:
    _, bmu, _ = unit
    bmu.run(10.5)
    assert len(bmu.all(TMS_BMS_0)) in (10, 11)
    first = bmu.all(TMS_BMS_0)[0]
    assert (first.work_sts, first.hv_rly_sts) == (ThermalMode.OFF, HvRelayState.OPEN)


def test_it_takes_over_the_mode_and_closes_its_relay(unit: Unit) -> None:
    _, bmu, _ = unit
    bmu.say(COOL)
    bmu.run(2.1)
    last = bmu.last(TMS_BMS_0)
    assert (last.work_sts, last.hv_rly_sts) == (ThermalMode.COOLING, HvRelayState.CLOSED)
    assert last.reqst_cap != 0


def test_the_water_comes_to_the_set_temperature(unit: Unit) -> None:
    _, bmu, _ = unit
    bmu.say(COOL)
    bmu.run(2.0)
    before = float(bmu.last(TMS_BMS_0).output_water_temp)
    bmu.run(150.0)
    after = bmu.last(TMS_BMS_0)
    assert before > 24.0
    assert after.output_water_temp == pytest.approx(15.0, abs=2.0)
    assert float(after.input_water_temp) > float(after.output_water_temp)


def test_heating_makes_the_inlet_the_colder_end(unit: Unit) -> None:
    _, bmu, _ = unit
    bmu.say(replace(COOL, reqst_set_tms_sts=ThermalMode.HEATING, set_temp=35.0))
    bmu.run(150.0)
    last = bmu.last(TMS_BMS_0)
    assert last.output_water_temp == pytest.approx(35.0, abs=2.0)
    assert float(last.input_water_temp) < float(last.output_water_temp)


@pytest.mark.parametrize(
    "wanted",
    [
        replace(COOL, hv_rly_sts=HvRelayState.OPEN),
        replace(COOL, reqst_tms_hv_on=HvRequest.REQUEST_HV_OFF),
    ],
    ids=["pack_open", "not_requested"],
)
def test_without_high_voltage_it_only_circulates(unit: Unit, wanted: BMS_TMS_0) -> None:
    _, bmu, _ = unit
    bmu.say(wanted)
    bmu.run(2.1)
    last = bmu.last(TMS_BMS_0)
    assert (last.work_sts, last.hv_rly_sts) == (ThermalMode.SELF_CIRCULATION, HvRelayState.OPEN)


def test_without_the_bmu_it_switches_off_within_five_periods(unit: Unit) -> None:
    _, bmu, _ = unit
    bmu.say(COOL)
    bmu.run(3.0)
    bmu.hush(BMS_TMS_0)
    bmu.run(6.1)
    last = bmu.last(TMS_BMS_0)
    assert (last.work_sts, last.hv_rly_sts) == (ThermalMode.OFF, HvRelayState.OPEN)


def test_its_fault_is_reported_stops_it_and_can_be_healed(unit: Unit) -> None:
    tms, bmu, _ = unit
    bmu.say(COOL)
    bmu.run(2.1)
    assert bmu.last(TMS_BMS_0).fault_lv == WarningLevel.INACTIVE
    tms.inject("tms_fault")
    bmu.run(1.1)
    last = bmu.last(TMS_BMS_0)
    assert (last.fault_lv, last.work_sts) == (WarningLevel.LEVEL_2, ThermalMode.OFF)
    assert last.fault_code != 0
    tms.heal("tms_fault")
    bmu.run(1.1)
    last = bmu.last(TMS_BMS_0)
    assert (last.fault_lv, last.fault_code) == (WarningLevel.INACTIVE, 0)
    assert last.work_sts == ThermalMode.COOLING
