"""The rules about requests, beyond their case folders."""

from __future__ import annotations

from pathlib import Path

import pytest
from rules.in_blocks import candump, essence, found, result_of
from rules.recorded import recorded, written

from swapcan.conform import Status, judge_log, rule_of

CASES = Path(__file__).with_name("cases")

RULES = IN_TIME, UNASKED, WITHDRAWN = tuple(
    rule_of(each) for each in ("answer-in-time", "answer-unasked", "request-withdrawn")
)

ASK_INFO, ASK_CODE, ASK_NOTHING = (
    f"can0 1801F3EF#{2 * f'{code:02X}'}000000000000" for code in (0x09, 0x06, 0x0A)
)
ASK_VIN, ASK_NO_VIN, VIN_INVALID = (
    f"can0 1801D0F3#{code:02X}00000000000000" for code in (0x09, 0x0A, 0x0B)
)
INFO_1, INFO_2 = "can0 18E5D0F3#18010003D7003300", "can0 18E6D0F3#0218000C00201924"
VIN = "can0 18E1F3D0#0131313131313131"
FROM_BMU, FROM_VCU = "can0 1883D0F3#0000000000000000", "can0 1802F3D0#0000000000000000"


def test_simulated_nodes_ask_answer_and_withdraw(tmp_path: Path) -> None:
    frames = recorded("ask@2s", seconds=4.0, nodes=("BMU", "VCU"))
    judgement = judge_log(written(frames, tmp_path / "asked.log"), rules=RULES)
    assert [result.count for result in judgement.results] == [0, 0, 0]
    assert judgement.result("answer-in-time").examined == 3  # the VIN, basic data, the pack code
    assert judgement.result("request-withdrawn").examined == 3


def test_all_answers_that_are_missing_are_named(tmp_path: Path) -> None:
    log = candump(
        tmp_path / "a.log",
        f"1 {FROM_BMU}",
        f"2 {ASK_CODE}",
        "2.1 can0 18E2D0F3#4F38305357415052",
        f"4.1 {FROM_BMU}",
    )
    assert found(result_of(IN_TIME, log)) == [
        (
            "V2B_RD_RQSysCode",
            1.0,
            3.0,
            1,
            "no B2V_SysCode1, B2V_SysCode3, B2V_SysCode4 within 2 s of the request",
        )
    ]
    assert result_of(IN_TIME, log, nodes=["VCU"]).status is Status.NOT_JUDGED


def test_an_answer_with_a_wrong_checksum_is_none(tmp_path: Path) -> None:
    code = ["18E1D0F3#D0C1303031504232", "18E3D0F3#3431454131303030", "18E4D0F3#0730303235000000"]
    log = candump(
        tmp_path / "a.log",
        f"0 {ASK_CODE}",
        *(f"0.1 can0 {frame}" for frame in code),
        "0.2 can0 18E2D0F3#0038305357415052",
        f"3 {FROM_BMU}",
    )
    assert [said for *_, said in found(result_of(IN_TIME, log))] == [
        "no B2V_SysCode2 within 2 s of the request"
    ]


@pytest.mark.parametrize(
    "lines",
    [
        pytest.param([f"2.1 {FROM_VCU}"], id="the node that is asked is absent"),
        pytest.param([f"0.5 {FROM_VCU}", f"1.9 {ASK_NO_VIN}", f"3 {FROM_VCU}"], id="withdrawn"),
        pytest.param([f"0.5 {FROM_VCU}", f"1.9 {VIN_INVALID}", f"3 {FROM_VCU}"], id="invalid"),
        pytest.param([f"0.5 {FROM_VCU}", f"2 {FROM_VCU}"], id="the log ends before"),
    ],
)
def test_a_request_without_evidence_is_not_judged(tmp_path: Path, lines: list[str]) -> None:
    log = candump(tmp_path / "a.log", f"0 {ASK_VIN}", *lines)
    assert result_of(IN_TIME, log).status is Status.NOT_JUDGED


def test_a_request_that_is_repeated_counts_from_its_first_frame(tmp_path: Path) -> None:
    log = candump(
        tmp_path / "a.log",
        f"0 {ASK_VIN}",
        f"1 {ASK_VIN}",
        f"1.5 {FROM_VCU}",
        f"2.5 {VIN}",
        f"3 {ASK_NO_VIN}",
        f"4 {ASK_VIN}",
        f"4.5 {VIN}",
    )
    result = result_of(IN_TIME, log)
    assert [(start, end) for _, start, end, _, _ in found(result)] == [(0.0, 2.0)]
    assert result.examined == 2


def test_tolerances_can_be_others(tmp_path: Path) -> None:
    log = candump(tmp_path / "a.log", f"0 {ASK_VIN}", f"2.5 {VIN}", f"9 {ASK_NO_VIN}")
    limits = {"answer-in-time.seconds": 3.0, "request-withdrawn.seconds": 6.0}
    judgement = judge_log(log, rules=RULES, limits=limits)
    assert judgement.result("answer-in-time").status is Status.PASSED
    assert judgement.result("request-withdrawn").status is Status.NOTED


def test_answers_are_not_judged_where_a_request_may_be_older_than_the_log(tmp_path: Path) -> None:
    answers = [f"{0.1 * number:.1f} {INFO_1}" for number in range(300)]
    log = candump(tmp_path / "a.log", f"0 {FROM_VCU}", *answers)
    assert result_of(UNASKED, log).status is Status.NOT_JUDGED


def test_answers_are_not_judged_where_the_asking_node_is_absent(tmp_path: Path) -> None:
    answers = [f"{number} {INFO_1}" for number in range(30)]
    log = candump(tmp_path / "a.log", *answers)
    assert result_of(UNASKED, log).status is Status.NOT_JUDGED


def test_answers_that_go_on_for_ever_are_one_occurrence_each(tmp_path: Path) -> None:
    answers = [f"{number} {frame}" for number in range(3, 100) for frame in (INFO_1, INFO_2)]
    log = candump(tmp_path / "a.log", f"0 {ASK_NOTHING}", *answers)
    said = "sent though the VCU has not asked since the log began, 99 s before"
    whole = result_of(UNASKED, log)
    assert found(whole) == [
        ("B2V_BattInfo1", 3.0, 99.0, 97, said),
        ("B2V_BattInfo2", 3.0, 99.0, 97, said),
    ]
    assert essence(result_of(UNASKED, log, 7)) == essence(whole)


def test_a_request_in_force_allows_its_own_answers_only(tmp_path: Path) -> None:
    log = candump(
        tmp_path / "a.log",
        f"0 {ASK_NOTHING}",
        f"3 {ASK_CODE}",
        f"4 {INFO_1}",
        f"5 {ASK_INFO}",
        f"6 {INFO_1}",
    )
    assert [start for _, start, *_ in found(result_of(UNASKED, log))] == [4.0]
    assert result_of(UNASKED, log).examined == 2


def test_a_request_that_is_never_answered_need_not_be_withdrawn(tmp_path: Path) -> None:
    log = candump(tmp_path / "a.log", f"0 {ASK_INFO}", f"1 {INFO_1}", f"60 {INFO_1}")
    assert result_of(WITHDRAWN, log).status is Status.NOT_JUDGED
