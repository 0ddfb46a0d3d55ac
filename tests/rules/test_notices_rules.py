"""What nodes tell of themselves, beyond the case folders of its rules."""

from __future__ import annotations

from pathlib import Path

import pytest
from rules.handmade import Bench, at, every
from rules.in_blocks import judged
from rules.recorded import recorded, written

from swapcan.conform import Severity
from swapcan.rules.notices import RULES


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    return Bench(tmp_path, RULES)


def test_nothing_that_a_node_tells_breaks_the_standard() -> None:
    musts = [rule.id for rule in RULES if rule.severity is Severity.MUST]
    assert musts == []


def test_an_alarm_is_told_once_over_frames_that_are_lost(bench: Bench) -> None:
    raised = at([0.0, 0.1, 0.4], "B2V_ST1", B2V_ST1_Flt_Fire=1)
    assert bench.finds(raised)["alarm-raised"] == ["B2V_ST1_Flt_Fire: 0.00 to 0.40 s"]


def test_an_alarm_is_told_again_after_a_silence(bench: Bench) -> None:
    raised = at([0.0, 0.1, 5.0], "B2V_ST1", B2V_ST1_Flt_Fire=1)
    assert bench.finds(raised)["alarm-raised"] == [
        "B2V_ST1_Flt_Fire: 0.00 to 0.10 s",
        "B2V_ST1_Flt_Fire: 5.00 to 5.00 s",
    ]


def test_a_connector_whose_state_nobody_defined_is_not_called_open(bench: Bench) -> None:
    on = at(every(0.1, 0, 2), "B2V_ST1", B2V_ST1_BMS=2)
    for state, wrong in ((0, []), (2, ["BSU_ConnectSt: 0.05 to 1.95 s"]), (3, [])):
        lock = at(every(0.1, 0.05, 1.95), "BSU_BMS_0", BSU_Lock=2, BSU_ConnectSt=state)
        assert bench.finds(on, lock)["lock-while-voltage"] == wrong


@pytest.mark.parametrize(
    ("fault", "told"),
    [
        ("over_temperature", {"alarm-raised", "hv-off-asked"}),
        ("low_insulation", {"alarm-raised", "hv-off-asked"}),
        ("tms_fault", {"alarm-raised", "cooling-fault-told"}),
        ("connector_over_temperature", {"connector-warning-told"}),
        ("BMU.lost_frame", set()),
    ],
)
def test_a_fault_is_told_by_the_node_that_has_it(
    tmp_path: Path, fault: str, told: set[str]
) -> None:
    frames = recorded("hv_on@1s", f"{fault}@2s", seconds=5.5, nodes=("BMU", "VCU", "TMS", "BSU"))
    judgement = judged(written(frames, tmp_path / "run.log"), RULES)
    assert {result.rule.id for result in judgement.results if result.count} == told
