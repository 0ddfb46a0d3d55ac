"""The rules on the cooling unit, beyond their case folders."""

from __future__ import annotations

from pathlib import Path

import pytest
from rules.handmade import Bench, Sketch, at, every

from swapcan.rules.cooling import RULES

OFF, COOLING, HEATING, CIRCULATION = 0, 1, 2, 3
HV_ON, HV_OFF = 0, 1


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    return Bench(tmp_path, RULES)


def asked(mode: int, high_voltage: int = HV_OFF, relay: int = 0) -> list[Sketch]:
    return at(
        every(1, 0, 10),
        "BMS_TMS_0",
        BMS_ReqstSetTMSts=mode,
        BMS_ReqstTMSHVon=high_voltage,
        BMS_HVRlySts=relay,
    )


def does(mode: int, **signals: int) -> list[Sketch]:
    return at(every(1, 0.5, 10.5), "TMS_BMS_0", TMS_WorkSts=mode, **signals)


@pytest.mark.parametrize("mode", [COOLING, HEATING])
def test_a_unit_has_to_cool_and_heat_only_with_high_voltage(bench: Bench, mode: int) -> None:
    wrong = ["TMS_WorkSts: 0.50 to 10.50 s"]
    rule = "cooling-mode-followed"
    assert bench.finds(asked(mode, HV_ON, relay=1), does(CIRCULATION))[rule] == wrong
    assert rule not in bench.finds(asked(mode, HV_ON, relay=0), does(CIRCULATION))
    assert rule not in bench.finds(asked(mode, HV_OFF, relay=1), does(CIRCULATION))


def test_a_unit_that_tells_of_a_fault_does_not_have_to_follow(bench: Bench) -> None:
    for fault in ({"TMS_FaultLv": 1}, {"TMS_FaultCode": 5}):
        assert "cooling-mode-followed" not in bench.finds(asked(CIRCULATION), does(OFF, **fault))


def test_a_unit_that_is_told_nothing_is_not_judged(bench: Bench) -> None:
    assert bench.finds(does(COOLING, TMS_HVRlySts=1)) == {}


def test_codes_of_the_request_that_nobody_defined_are_none_for_off(bench: Bench) -> None:
    for code in (2, 3):
        found = bench.finds(asked(OFF, code), does(OFF, TMS_HVRlySts=1))
        assert "cooling-voltage-asked" not in found


def test_either_side_of_the_main_relays_is_the_packs_voltage(bench: Bench) -> None:
    told = at(every(1, 0.5, 5.5), "BMS_TMS_0", BMS_Volt=600)
    times = every(0.1, 0, 5.5)
    open_relays = at(times, "B2V_ST3", B2V_ST3_Upack_Batt=6000, B2V_ST3_Upack_Out=10)
    back_fed = at(times, "B2V_ST3", B2V_ST3_Upack_Batt=65535, B2V_ST3_Upack_Out=6000)
    neither = at(times, "B2V_ST3", B2V_ST3_Upack_Batt=5500, B2V_ST3_Upack_Out=10)
    rule = "cooling-told-voltage"
    assert bench.finds(told, open_relays)[rule] == []
    assert rule not in bench.finds(told, back_fed)
    assert bench.finds(told, neither)[rule] == ["BMS_Volt: 0.50 to 5.50 s"]
