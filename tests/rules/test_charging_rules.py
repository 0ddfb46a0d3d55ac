"""The rules on charging, beyond their case folders."""

from __future__ import annotations

from pathlib import Path

import pytest
from rules.handmade import Bench, Sketch, at, every

from swapcan.rules.charging import RULES

START, STOP = 0, 1
WITHOUT_CURRENT = 10000  # raw: 0 A


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    return Bench(tmp_path, RULES)


def charging(end: float, high_voltage: int = 0, *, begin: float = 0.0) -> list[Sketch]:
    return at(
        every(0.1, begin, end),
        "B2V_ST1",
        B2V_ST1_BMS=high_voltage,
        B2V_ST1_ChgSt=1,
        B2V_ST1_ChgLine=1,
    )


def current(end: float, amperes: int) -> list[Sketch]:
    raw = WITHOUT_CURRENT + 10 * amperes
    return at(every(0.1, 0.05, end - 0.05), "B2V_ST2", B2V_ST2_Current=raw)


def charger(end: float, **signals: int) -> list[Sketch]:
    return at(every(0.5, 0.02, end), "C2B_ACStatus", **signals)


def order(end: float, control: int, **signals: int) -> list[Sketch]:
    return at(every(0.5, 0.0, end), "B2C_Charger", B2V_S_ChargeControl=control, **signals)


def test_a_wrong_sign_is_found_without_a_charger_in_the_log(bench: Bench) -> None:
    right, wrong = (
        bench.finds(charging(3), current(3, -80)),
        bench.finds(charging(3), current(3, 80)),
    )
    assert right["charge-current-sign"] == []
    assert wrong["charge-current-sign"] == ["B2V_ST2_Current: 0.05 to 2.95 s"]


def test_where_the_truck_may_draw_only_a_strong_charger_tells_the_sign(bench: Bench) -> None:
    idle = at(every(0.1, 0.0, 0.9), "B2V_ST1", B2V_ST1_BMS=2)
    draws = idle, charging(4, high_voltage=2, begin=1.0), current(4, 30)
    strong = charger(4, C2B_N_CurrentOutput=900)
    assert "charge-current-sign" not in bench.finds(*draws)
    assert "charge-current-sign" not in bench.finds(*draws, charger(4, C2B_N_CurrentOutput=700))
    assert bench.finds(*draws, strong)["charge-current-sign"] != []


def test_what_the_truck_draws_is_not_known_where_a_log_begins_while_it_charges(
    bench: Bench,
) -> None:
    strong = charger(4, C2B_N_CurrentOutput=900)
    found = bench.finds(charging(4, high_voltage=2), current(4, 30), strong)
    assert "charge-current-sign" not in found


@pytest.mark.parametrize(
    ("fault", "ends"),
    [
        ("C2B_F_ChargerHardware", True),
        ("C2B_F_ChargerOverTemp", False),
        ("C2B_F_ChargerInputVoltage", True),
        ("C2B_F_Charger_CAN", True),
    ],
)
def test_charging_has_to_end_on_the_faults_for_which_table_19_says_so(
    bench: Bench, fault: str, *, ends: bool
) -> None:
    wrong = bench.finds(charging(5), order(5, START), charger(5, **{fault: 1}))
    assert bool(wrong.get("charge-stops-on-fault")) is ends


def test_charging_has_ended_where_either_message_says_so(bench: Bench) -> None:
    fault = charger(5, C2B_F_ChargerHardware=1)
    ended = at(every(0.1, 0, 5), "B2V_ST1", B2V_ST1_ChgSt=3, B2V_ST1_ChgLine=1)
    assert bench.finds(charging(5), fault)["charge-stops-on-fault"] != []
    assert bench.finds(charging(5), order(5, STOP), fault)["charge-stops-on-fault"] == []
    assert bench.finds(ended, order(5, START), fault)["charge-stops-on-fault"] == []


def test_a_charger_that_nobody_tells_anything_is_not_judged(bench: Bench) -> None:
    gives = charger(10, C2B_N_CurrentOutput=500, C2B_N_VoltageOutput=6000)
    assert not any(bench.finds(gives).values())
    # The last order counts for 1.75 s: too short for any of the times that are allowed.
    assert not any(bench.finds(gives, order(0, STOP)).values())
    assert bench.finds(gives, order(10, STOP))["charger-stops"] != []
