"""The rules on high voltage, beyond their case folders."""

from __future__ import annotations

from pathlib import Path

import pytest
from rules.handmade import Bench, Sketch, at, every, found
from rules.in_blocks import judged
from rules.recorded import recorded, written

from swapcan.rules.voltage import RULES

OPEN, PRECHARGE, CLOSED = 0, 1, 2
ON, OFF = 1, 2


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    return Bench(tmp_path, RULES)


def states(times: list[float], state: int, **others: int) -> list[Sketch]:
    return at(times, "B2V_ST1", B2V_ST1_BMS=state, **others)


def commands(times: list[float], command: int) -> list[Sketch]:
    return at(times, "V2B_CMD", V2B_CMD_HV_OnOff=command)


def relays(times: list[float], positive: int, negative: int, precharge: int) -> list[Sketch]:
    return at(
        times,
        "B2V_ST0",
        B2V_ST0_ST_MainPos=positive,
        B2V_ST0_ST_MainNeg=negative,
        B2V_ST0_ST_Prechg=precharge,
    )


def discharged(times: list[float], raw_current: int, raw_limit: int) -> list[Sketch]:
    return at(times, "B2V_ST2", B2V_ST2_Current=raw_current, B2V_ST2_MaxLmt_DisChgCurr=raw_limit)


def run(folder: Path, plan: str, *faults: str, seconds: float) -> dict[str, list[str]]:
    frames = recorded(plan, *faults, seconds=seconds, nodes=("BMU", "VCU"))
    return found(judged(written(frames, folder / "run.log"), RULES))


WITHOUT_CAUSE = {"hv-off-requested", "drive-ends-on-alarm"}
"""Rules that have nothing to judge where a pack neither asks for anything nor raises an alarm."""


def test_a_simulated_truck_keeps_all_of_them(tmp_path: Path) -> None:
    clean = run(tmp_path, "hv_on@1s, drive@3s+5s, hv_off@9s", seconds=14.0)
    assert clean == {rule.id: [] for rule in RULES if rule.id not in WITHOUT_CAUSE}


def test_a_relay_that_welds_is_found_by_the_command_off_alone(tmp_path: Path) -> None:
    what = run(tmp_path, "hv_on@1s, hv_off@4s", "welded_relay@3s", seconds=10.5)
    assert [rule for rule, times in what.items() if times] == ["hv-off-in-time"]
    assert [each.partition(":")[0] for each in what["hv-off-in-time"]] == ["B2V_ST0_ST_MainPos"]


@pytest.mark.parametrize("fault", ["BMU.lost_frame", "VCU.lost_frame", "VCU.stuck_counter"])
def test_a_fault_of_the_transmission_is_none_of_the_sequence(tmp_path: Path, fault: str) -> None:
    what = run(tmp_path, "hv_on@1s, hv_off@4s", f"{fault}@0s", seconds=10.5)
    assert not any(what.values())


def test_a_precharge_that_was_not_seen_as_frames_are_missing_is_not_judged(bench: Bench) -> None:
    before = relays([0.0, 0.3, 0.6], 1, 2, 1)
    assert "precharge-first" in bench.finds(before, relays([0.7], 2, 2, 1))
    assert "precharge-first" not in bench.finds(before, relays([1.0], 2, 2, 1))


def test_the_state_precharge_is_proof_of_a_precharge_too(bench: Bench) -> None:
    closing = relays([0.0, 0.3, 0.6], 1, 2, 1), relays([0.7], 2, 2, 1)
    told = states([0.4], PRECHARGE)
    assert bench.finds(*closing)["precharge-first"] == ["B2V_ST0_ST_MainPos: 0.70 to 0.70 s"]
    assert bench.finds(*closing, told)["precharge-first"] == []


def test_the_precharge_of_the_last_time_is_none_for_this_one(bench: Bench) -> None:
    first = relays([0.0, 0.3], 1, 2, 1), relays([0.6], 1, 2, 2), relays([0.7], 2, 2, 1)
    again = relays([1.0, 1.3, 1.6], 1, 2, 1), relays([1.7], 2, 2, 1)
    assert bench.finds(*first, *again)["precharge-first"] == ["B2V_ST0_ST_MainPos: 1.70 to 1.70 s"]


def test_a_command_whose_counter_stands_still_does_not_have_to_be_obeyed(bench: Bench) -> None:
    ignored = commands(every(0.1, 0, 6), OFF), states(every(0.1, 0.05, 6.05), CLOSED)
    assert bench.finds(*ignored)["hv-off-in-time"] == ["B2V_ST1_BMS: 0.05 to 6.05 s"]
    assert not any(bench.finds(*ignored, stuck=True).values())


def test_a_pack_that_charges_may_stay_closed(bench: Bench) -> None:
    charging = states(every(0.1, 0.05, 6.05), CLOSED, B2V_ST1_ChgSt=1, B2V_ST1_ChgLine=1)
    assert not any(bench.finds(commands(every(0.1, 0, 6), OFF), charging).values())


def test_a_time_given_for_a_run_counts(bench: Bench) -> None:
    late = commands(every(0.1, 0, 6), OFF), states(every(0.1, 0.05, 6.05), CLOSED)
    assert bench.finds(*late, limits={"hv-off-in-time.seconds": 6.5})["hv-off-in-time"] == []
    assert bench.finds(*late, limits={"hv-off-in-time.seconds": 5.5})["hv-off-in-time"] != []


def test_a_pack_that_opens_by_itself_is_not_one_that_does_not_switch_on(bench: Bench) -> None:
    told = commands([0.0], OFF), commands(every(0.1, 0.1, 9), ON)
    on = states([0.05], OPEN), states(every(0.1, 0.15, 1), PRECHARGE), states([1.25], CLOSED)
    opens = states(every(0.1, 1.35, 9), OPEN)
    assert bench.finds(*told, *on, opens)["hv-on-in-time"] == []
    assert bench.finds(*told, *on, opens, block=1)["hv-on-in-time"] == []


def test_a_command_that_was_there_before_the_log_is_not_judged(bench: Bench) -> None:
    told = commands(every(0.1, 0, 5), ON)
    assert "hv-on-in-time" not in bench.finds(told, states(every(0.1, 0.05, 5.05), OPEN))


def test_a_precharge_soon_after_the_logs_begin_may_have_been_commanded_before(
    bench: Bench,
) -> None:
    off = commands(every(0.1, 0, 1.5), OFF)
    for begin, judged_there in ((0.5, False), (1.4, True)):
        sequence = states([begin - 0.1], OPEN), states([begin], PRECHARGE)
        assert ("hv-only-on-command" in bench.finds(off, *sequence)) is judged_there


def test_a_pack_that_says_why_does_not_have_to_switch_on(bench: Bench) -> None:
    told = commands([0.0], OFF), commands(every(0.1, 0.1, 4), ON)
    ready = states([0.05], OPEN)
    stays = every(0.1, 0.15, 4.05)
    found_wrong = ["B2V_ST1_BMS: 0.15 to 4.05 s"]
    assert bench.finds(*told, ready, states(stays, OPEN))["hv-on-in-time"] == found_wrong
    fault = states(stays, OPEN, B2V_ST1_Fault_Levl=3)
    assert not any(bench.finds(*told, ready, fault).values())
    request = at([0.12], "B2V_RQ", B2V_RQ_HVOff=1)
    assert not bench.finds(*told, ready, states(stays, OPEN), request).get("hv-on-in-time")


def test_the_request_of_a_pack_that_was_swapped_is_forgotten(bench: Bench) -> None:
    request = at([0.0], "B2V_RQ", B2V_RQ_HVOff=1)
    driven = commands(every(0.1, 10, 20), ON)
    same, other = states(every(0.1, 0.05, 20.05), CLOSED), states(every(0.1, 9.95, 20.05), CLOSED)
    assert bench.finds(request, driven, same)["hv-off-requested"] != []
    assert "hv-off-requested" not in bench.finds(request, driven, states([0.05], OPEN), other)


def test_a_current_is_judged_only_where_a_truck_is_heard(bench: Bench) -> None:
    over = discharged(every(0.1, 0.05, 2.05), 13000, 2000)  # 300 A, 200 A allowed
    heard = bench.finds(over, commands(every(0.1, 0, 2), ON))
    assert heard["discharge-limit"] == ["B2V_ST2_Current: 0.05 to 2.05 s"]
    assert "discharge-limit" not in bench.finds(over)


@pytest.mark.parametrize(("current", "limit"), [(65535, 2000), (13000, 65535)])
def test_a_current_without_a_valid_value_is_not_judged(
    bench: Bench, current: int, limit: int
) -> None:
    over = discharged(every(0.1, 0.05, 2.05), current, limit)
    assert "discharge-limit" not in bench.finds(over, commands(every(0.1, 0, 2), ON))
