"""Faults and steps as people type them, with the times at which they come and go."""

from __future__ import annotations

import math

import pytest

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import B2V_ST1
from swapcan.nodes.faults import FAULTS, able_nodes, planned_fault
from swapcan.nodes.plan import DEFAULT_PLAN, STEPS, plan_of, planned_step
from typedcan.simulate.faults import TRANSMISSION_FAULTS
from typedcan.simulate.times import PlanError, seconds_of


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("30s", 30),
        ("500ms", 0.5),
        ("2min", 120),
        ("1.5h", 5400),
        ("30", 30),
        ("0s", 0),
        ("1.25 s", 1.25),
    ],
)
def test_times_have_units(text: str, seconds: float) -> None:
    assert seconds_of(text) == seconds


@pytest.mark.parametrize(
    "text", ["", "s", "-1s", "1e3s", "3 days", "soon", "1s2", "nan", "inf", "٣s"]
)
def test_what_is_no_time_is_refused_in_one_line(text: str) -> None:
    with pytest.raises(PlanError, match=r"^expected a time such as 30s, 500ms or 2min, not .*$"):
        seconds_of(text)


def test_a_fault_comes_at_its_start_and_stays() -> None:
    fault = planned_fault("over_temperature@30s")
    assert (fault.name, fault.start, fault.end, fault.nodes) == (
        "over_temperature",
        30.0,
        math.inf,
        ("BMU",),
    )


def test_a_duration_lets_a_fault_go_again() -> None:
    fault = planned_fault(" lost_frame@5s+500ms ")
    assert (fault.start, fault.end) == (5.0, 5.5)
    assert fault.nodes == PROTOCOL.nodes


def test_a_node_before_the_name_has_the_fault_alone() -> None:
    fault = planned_fault("VCU.bus_silence@1min")
    assert (fault.nodes, fault.messages) == (("VCU",), ())


def test_a_message_before_the_name_has_the_fault_alone() -> None:
    fault = planned_fault("B2V_ST1.stuck_counter@0s+1s")
    assert (fault.nodes, fault.messages) == (("BMU",), (B2V_ST1,))


def test_a_fault_without_a_target_is_for_all_that_can_have_it() -> None:
    assert able_nodes("wrong_checksum") == ("BMU", "VCU")
    assert able_nodes("stuck_counter") == ("BMU", "VCU", "BSU")
    assert able_nodes("tms_fault") == ("TMS",)
    assert able_nodes("bus_silence") == PROTOCOL.nodes


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("over_temperature", "expected NAME@TIME, such as over_temperature@30s"),
        ("@30s", "expected NAME@TIME, such as over_temperature@30s"),
        ("overtemp@30s", "there is no fault 'overtemp'; known: lost_frame, "),
        ("lost_frame@", "expected a time such as"),
        ("lost_frame@1s+", "expected a time such as"),
        ("VCU.over_temperature@1s", "VCU cannot have over_temperature; it is for BMU"),
        ("CHG.stuck_counter@1s", "CHG cannot have stuck_counter; it is for BMU, VCU, BSU"),
        ("B2V_ST2.stuck_counter@1s", "the frames of B2V_ST2 cannot have stuck_counter"),
        ("B2V_ST2.over_temperature@1s", "the frames of B2V_ST2 cannot have over_temperature"),
        ("XYZ.lost_frame@1s", "there is no node or message 'XYZ'"),
    ],
)
def test_a_fault_that_cannot_be_is_refused_in_one_line(text: str, reason: str) -> None:
    with pytest.raises(PlanError) as caught:
        planned_fault(text)
    assert str(caught.value).startswith(reason)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "text", ["lost_frame@5s+0.5s", "VCU.bus_silence@60s", "B2V_ST1.stuck_counter@0s"]
)
def test_a_fault_says_itself_as_it_was_typed(text: str) -> None:
    assert str(planned_fault(text)) == text
    assert planned_fault(str(planned_fault(text))) == planned_fault(text)


def test_every_fault_is_described_in_one_line() -> None:
    for name, kind in FAULTS.items():
        assert name == kind.name
        assert 10 < len(kind.text) < 80
        assert "\n" not in kind.text
        assert kind.is_transmission == (name in TRANSMISSION_FAULTS)


def test_a_plan_is_steps_with_commas_between() -> None:
    plan = plan_of("hv_on@1s, drive@3s+30s,hv_off@40s")
    assert [(step.name, step.start, step.end) for step in plan] == [
        ("hv_on", 1.0, math.inf),
        ("drive", 3.0, 33.0),
        ("hv_off", 40.0, math.inf),
    ]


def test_an_empty_plan_has_no_steps() -> None:
    assert plan_of(" ") == ()


def test_a_step_that_does_not_exist_is_refused() -> None:
    with pytest.raises(PlanError, match=r"there is no step 'fly'; known: hv_on, drive, "):
        planned_step("fly@1s")


def test_the_default_plan_is_on_drive_charge_off() -> None:
    names = [step.name for step in DEFAULT_PLAN if step.name != "ask"]
    assert names == ["hv_on", "drive", "charge", "hv_off"]
    assert {step.name for step in DEFAULT_PLAN} <= set(STEPS)
