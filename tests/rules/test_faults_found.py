"""Each fault that can be injected is found by the rules that are meant for it, and by no others."""

from __future__ import annotations

from typing import Any

import pytest
from rules.in_blocks import broken, judged_by_all
from rules.recorded import recorded

from swapcan.conform import RULES, Judgement, Severity, Status, Verdict
from swapcan.simulate import FAULTS, planned_fault

DRIVE = "hv_on@0.5s, ask@0.7s, drive@1.5s+2s, hv_off@7s"
CHARGE = "hv_on@0.5s, charge@2s+8s"
SECONDS = 8.0
LONGER = {
    **{f"TMS.{fault}": 13.0 for fault in ("lost_frame@2s+8s", "late_frame@2s+8s")},
    **{f"CHG.{fault}": 11.0 for fault in ("lost_frame@3s+5s", "late_frame@4s+4s")},
    "CHG.bus_silence@5s+4s": 11.0,
    "TMS.bus_silence@2s+7s": 12.0,
    "sensor_failure@2s": 10.0,
    "welded_relay@2s": 13.0,
}
"""Seconds of a run; the longer ones show what takes its time."""

FOUND: dict[str, set[str]] = {
    # A lost frame leaves a gap, a counter that skips, a cycle that lacks a part, a longer mean.
    "BMU.lost_frame@2s+2s": {
        *("period-gap", "counter-sequence", "cells-complete", "probes-complete"),
    },
    "VCU.lost_frame@2s+2s": {"period-gap", "counter-sequence"},
    "CHG.lost_frame@3s+5s": {"period-gap", "period-mean"},
    "TMS.lost_frame@2s+8s": {"period-gap", "period-mean"},
    "BSU.lost_frame@2s+2s": {"period-gap", "counter-sequence"},
    # Frames that are held back leave a gap, and come at once with those that overtook them.
    "BMU.late_frame@2s+2s": {"period-gap", "period-short", "period-jitter"},
    "VCU.late_frame@2s+2s": {"period-gap", "period-short", "period-jitter"},
    "CHG.late_frame@4s+4s": {"period-gap", "period-short", "period-jitter"},
    "TMS.late_frame@2s+8s": {"period-gap", "period-short", "period-jitter"},
    "BSU.late_frame@2s+2s": {"period-gap", "period-short", "period-jitter"},
    "BMU.stuck_counter@3s+1s": {"counter-sequence"},
    "VCU.stuck_counter@3s+1s": {"counter-sequence"},
    "BSU.stuck_counter@3s+1s": {"counter-sequence"},
    "BMU.wrong_checksum@3s+1s": {"checksum"},
    "VCU.wrong_checksum@3s+1s": {"checksum"},
    # BMS_Life comes once a second, so that it shows what was not sent in two.
    "BMU.bus_silence@3s+2s": {"node-silence", "counter-sequence"},
    "VCU.bus_silence@3s+2s": {"node-silence"},
    "CHG.bus_silence@5s+4s": {"node-silence"},
    "BSU.bus_silence@3s+2s": {"node-silence"},
    # The pack tells that its cooling unit is gone.
    "TMS.bus_silence@2s+7s": {"node-silence", "alarm-raised"},
    # The pack tells of what it measures, and asks for high voltage off where it is grave.
    "welded_relay@2s": {"hv-off-in-time", "alarm-raised", "hv-off-asked"},
    "stuck_relay@0s": {"hv-on-failed", "alarm-raised"},
    "precharge_failure@0s": {"hv-on-failed"},
    "over_temperature@2s": {"alarm-raised", "hv-off-asked"},
    "over_voltage_cell@2s": {"alarm-raised", "hv-off-asked"},
    "low_insulation@2s": {"alarm-raised", "hv-off-asked"},
    "sensor_failure@2s": {"alarm-raised", "reading-missing"},
    "charger_over_temperature@5s": {"charger-fault-told"},
    "charger_hardware@5s": {"charger-fault-told"},
    "charger_input_voltage@5s": {"charger-fault-told"},
    "tms_fault@2s": {"cooling-fault-told", "alarm-raised"},
    "connector_over_temperature@2s": {"connector-warning-told"},
}
"""By fault, with the second at which it comes: the rules that find it."""

SIGNALS: dict[str, set[str]] = {
    "welded_relay@2s": {"B2V_ST0_Flt_MainPosRelayWeld"},
    "stuck_relay@0s": {"B2V_ST0_Flt_MainPosRelayOpen"},
    "over_temperature@2s": {"B2V_ST1_Flt_OverTemp", "B2V_ST1_Flt_DelTemp"},
    "over_voltage_cell@2s": {"B2V_ST1_Flt_OverUcell", "B2V_ST1_Flt_UcellUniformity"},
    "low_insulation@2s": {"B2V_ST1_Flt_LowInsRes"},
    "sensor_failure@2s": {"B2V_ST1_Flt_HW"},
    "tms_fault@2s": {"B2V_ST0_Flt_TMS_System"},
    "TMS.bus_silence@2s+7s": {"B2V_ST0_Flt_TMS_System"},
    "charger_over_temperature@5s": {"C2B_F_ChargerOverTemp"},
    "charger_hardware@5s": {"C2B_F_ChargerHardware"},
    "charger_input_voltage@5s": {"C2B_F_ChargerInputVoltage"},
    "connector_over_temperature@2s": {"BSU_ConctorTempWarn"},
}
"""What the rules that only tell of a fault name: that fault, and what comes of it."""

LEFT_OPEN = {
    fault: {"counter-sequence"}
    for fault in ("BSU.stuck_counter@3s+1s", "BSU.lost_frame@2s+2s", "BMU.bus_silence@3s+2s")
}
"""The rules of which what is found is no demand, as the standard leaves it open (E49)."""

_TELLING = {"alarm-raised", "charger-fault-told", "connector-warning-told"}


def judged(plan: str, *faults: str, seconds: float, **options: Any) -> Judgement:
    """What all rules say of a run."""
    return judged_by_all(recorded(plan, *faults, seconds=seconds, **options))


def blamed(judgement: Judgement) -> set[str]:
    """The nodes that broke a rule."""
    return {
        each.subject.node
        for result in judgement.of_status(Status.FAILED)
        for each in result.occurrences
    }


@pytest.mark.parametrize("fault", FOUND)
def test_a_fault_is_found_by_its_rules_and_by_no_other(fault: str) -> None:
    plan = CHARGE if "CHG" in planned_fault(fault).nodes else DRIVE
    judgement = judged(plan, fault, seconds=LONGER.get(fault, SECONDS))
    assert broken(judgement) == FOUND[fault]
    assert blamed(judgement) <= set(planned_fault(fault).nodes)
    told = {each.subject.signal for rule in _TELLING for each in judgement.result(rule).occurrences}
    assert told == SIGNALS.get(fault, set())
    demands = {rule.id for rule in RULES if rule.severity is Severity.MUST} & FOUND[fault]
    broken_demands = {
        result.rule.id
        for result in judgement.results
        if result.count and result.severity is Severity.MUST
    }
    assert broken_demands == demands - LEFT_OPEN.get(fault, set())
    has_broken_a_demand = bool(broken_demands)
    expected = Verdict.VIOLATES if has_broken_a_demand else Verdict.CONFORMS
    assert judgement.verdict is expected


def test_every_fault_is_in_the_table_for_every_node_that_can_have_it() -> None:
    planned = [planned_fault(text) for text in FOUND]
    pairs = {(each.name, node) for each in planned for node in each.nodes}
    possible = {(name, node) for name in FAULTS for node in planned_fault(f"{name}@0s").nodes}
    assert pairs == possible


SCENARIOS: list[tuple[str, dict[str, Any]]] = [
    (DRIVE, {}),
    (CHARGE, {"seed": 7, "cscs": 4}),
    ("", {}),
    ("hv_on@0.5s, ask@1s, drive@2s+3s, hv_off@5s, unlock@11s+1s", {}),
    ("charge@1s+8s", {}),
    ("hv_on@0.5s, charge@2s+3s, hv_off@6s, hv_on@8s, drive@10s+1s, hv_off@12s", {}),
    ("hv_on@1s, drive@2s+5s, ask@6s, ask@9s", {"nodes": ("BMU", "VCU")}),
    ("", {"nodes": ("BMU",)}),
    ("charge@1s+8s", {"nodes": ("BMU", "CHG")}),
]
"""What the simulated nodes do when nothing is wrong: a plan, and what is not as usual."""


@pytest.mark.parametrize(("plan", "options"), SCENARIOS)
def test_the_simulated_nodes_conform_in_every_scenario(plan: str, options: dict[str, Any]) -> None:
    judgement = judged(plan, seconds=13.0, **options)
    assert judgement.verdict is Verdict.CONFORMS
    assert broken(judgement) == set()
