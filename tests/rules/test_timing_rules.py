"""Timing rules beyond their case folders: cuts, silences, clocks that jump, logs of one bus."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from pathlib import Path

import can
import pytest
from rules.recorded import recorded, written

from swapcan.conform import Judge, Judgement, Status, judge_log, rule_of
from swapcan.messages import (
    B2V_RQ,
    B2V_ST1,
    B2V_ST2,
    BSU_BMS_0,
    TMS_BMS_0,
    V2B_CMD,
    V2B_VIN,
    B2C_Charger,
    B2V_BattInfo2,
    B2V_ElecEnergy,
    B2V_SysCode1,
    B2V_Ucell,
    C2B_ACStatus,
    V2B_RQData,
)
from typedcan.judge.findings import KEPT
from typedcan.logs.read import open_log
from typedcan.wire.message import Message

CASES = Path(__file__).with_name("cases")
TIMING = [
    rule_of(each)
    for each in (
        *("period-mean", "period-jitter", "period-gap", "period-short", "node-silence"),
        *("event-repeated", "message-missing", "start-complete", "start-state"),
        *("relays-before-command", "bus-load"),
    )
]
LOGS = [CASES / rule.id / log for rule in TIMING for log in ("passes.log", "fails.log")]
EMPTY = bytes(8)
HV_OPEN = bytes(8)
HV_CLOSED = bytes([0x20, 0x20, 0, 0, 0, 0, 0, 0])
"""B2V_ST1: bits 12 and 13 are the BMU's state, byte 0 is the XOR of the others."""


def frame(
    time: float, message: type[Message], data: bytes = EMPTY, channel: str = "can0"
) -> can.Message:
    return can.Message(timestamp=time, arbitration_id=message.FRAME_ID, data=data, channel=channel)


def every(
    period: float, begin: float, end: float, message: type[Message], data: bytes = EMPTY
) -> list[can.Message]:
    count = round((end - begin) / period)
    return [frame(begin + number * period, message, data) for number in range(count + 1)]


def judged(path: Path, frames: Iterable[can.Message], block: int = 0) -> Judgement:
    """What timing rules find, with frames in the order of their times."""
    log = written(sorted(frames, key=lambda each: each.timestamp), path / "log.log")
    return in_blocks(log, block) if block else judge_log(log, rules=TIMING)


def in_blocks(log: Path, size: int) -> Judgement:
    judge = Judge(rules=TIMING)
    with open_log(log, size) as source:
        for block in source:
            judge.feed(block)
    return judge.finish()


def found(judgement: Judgement) -> Counter[tuple[str, str, str]]:
    """How often each rule found something, about whom and what."""
    return Counter(
        (result.rule.id, each.subject.node, str(each.subject))
        for result in judgement.results
        for each in result.occurrences
    )


def everything(judgement: Judgement) -> list[object]:
    """All that does not depend on the last digits of sums."""
    return [
        [each.rule.id, each.examined, each.count, each.frames]
        + [(e.subject, e.start, e.end, e.order, e.frames, e.says()) for e in each.occurrences]
        for each in judgement.results
    ]


def test_it_does_not_matter_where_a_log_with_faults_is_cut(tmp_path: Path) -> None:
    frames = recorded(
        "hv_on@0.5s, ask@1s, drive@2s", "BMU.bus_silence@4s+2s", "BMU.late_frame@7s+1s", seconds=9.0
    )
    log = written(frames, tmp_path / "faults.log")
    whole = everything(in_blocks(log, 10_000))
    assert sum(result.count for result in in_blocks(log, 10_000).results) > 20
    assert everything(in_blocks(log, 97)) == whole


@pytest.mark.parametrize(
    "silences",
    [{"BMU": 1.0}, {"VCU": 0.5}, {"BSU": 1.0, "TMS": 6.0}],
    ids="-".join,
)
def test_a_silent_node_is_found_for_its_silence_alone(
    silences: dict[str, float], tmp_path: Path
) -> None:
    faults = [f"{node}.bus_silence@2s+{seconds}s" for node, seconds in silences.items()]
    frames = recorded("hv_on@0.2s", *faults, seconds=3.0 + max(silences.values()))
    judgement = judge_log(written(frames, tmp_path / "log.log"), rules=TIMING)
    assert found(judgement) == {("node-silence", node, ""): 1 for node in silences}


def test_lost_frames_are_gaps_and_nothing_else(tmp_path: Path) -> None:
    frames = recorded("hv_on@0.2s", "VCU.lost_frame@2s+1s", seconds=4.0)
    judgement = judge_log(written(frames, tmp_path / "log.log"), rules=TIMING)
    assert found(judgement) == {("period-gap", "VCU", "V2B_CMD"): 5}


def test_a_bmu_may_sleep_and_wake_with_high_voltage_off(tmp_path: Path) -> None:
    frames = every(0.1, 0, 1, B2V_ST1, HV_CLOSED) + every(0.1, 1.1, 1.5, B2V_ST1, HV_OPEN)
    frames += every(0.1, 9, 10, B2V_ST1, HV_OPEN) + every(0.1, 0, 10, BSU_BMS_0)
    judgement = judged(tmp_path, frames)
    for rule in ("node-silence", "start-state", "start-complete", "period-gap"):
        assert judgement.result(rule).status is Status.PASSED


def test_a_message_that_does_not_come_back_after_a_silence_is_found_once(tmp_path: Path) -> None:
    frames = every(0.1, 0, 2, B2V_ST1) + every(0.1, 4, 6, B2V_ST1) + every(0.1, 0, 2, B2V_ST2)
    # 2 periods + 0.5 s after 4 s it is due at last; the node sends until 6 s.
    assert found(judged(tmp_path, frames)) == {
        ("start-complete", "BMU", "B2V_ST2"): 1,
        **{("message-missing", "BMU", name): 1 for name in MISSING},
    }


MISSING = ("B2V_Ucell", "B2V_Temp", "B2V_ST0", "B2V_ST3", "B2V_ST4", "B2V_ST5", "B2V_ST6")
"""What a BMU sends at least every 200 ms, apart from B2V_ST1 and B2V_ST2."""


def test_a_message_that_comes_only_with_the_second_start_was_missing_at_the_first(
    tmp_path: Path,
) -> None:
    frames = every(0.1, 2, 4, B2V_ST1) + every(0.1, 6, 8, B2V_ST1) + every(0.1, 6, 8, B2V_ST2)
    frames += every(0.1, 0, 8, BSU_BMS_0)
    for block in (0, 1):
        (start,) = judged(tmp_path, frames, block).result("start-complete").occurrences
        assert start.subject.message == "B2V_ST2"
        assert start.start == pytest.approx(2)
        assert start.end == pytest.approx(4)


def test_a_message_that_stops_before_a_silence_of_its_node_is_a_gap(tmp_path: Path) -> None:
    frames = every(0.1, 0, 2, B2V_ST1) + every(0.1, 4, 4.2, B2V_ST1) + every(0.1, 0, 1, B2V_ST2)
    (gap,) = judged(tmp_path, frames).result("period-gap").occurrences
    assert gap.start == pytest.approx(1)
    assert gap.end == pytest.approx(2)


def test_a_clock_that_goes_back_is_not_judged(tmp_path: Path) -> None:
    times = [100.0, 100.1, 100.2, 0.0, 0.1, 0.2, 0.3]
    log = written([frame(time, BSU_BMS_0) for time in times], tmp_path / "back.log")
    judgement = judge_log(log, rules=TIMING)
    assert not found(judgement)
    assert judgement.result("period-gap").examined == len(times) - 2
    # 7 frames in twice a few tenths of a second: as many as are due.
    assert judgement.result("bus-load").status is Status.PASSED


def test_more_gaps_than_are_kept_are_counted_and_the_worst_is_known(tmp_path: Path) -> None:
    frames = every(0.2, 0, 400, BSU_BMS_0)
    frames[1500].timestamp += 0.05
    for block in (0, 700):
        result = judged(tmp_path, frames, block).result("period-gap")
        # 2000 steps of 0.2 s; the one after the longest has 0.15 s, which is allowed.
        assert (result.count, result.frames, len(result.occurrences)) == (1999, 1999, KEPT)
        assert result.worst is not None
        assert result.worst.measure == pytest.approx(2.5)


def test_a_lost_frame_of_a_cycle_is_that_of_its_csc_and_number(tmp_path: Path) -> None:
    def cell(time: float, csc: int, number: int) -> can.Message:
        return frame(time, B2V_Ucell, bytes([number, csc, 0, 0, 0, 0, 0, 0]))

    frames = [
        cell(cycle * 0.1 + csc * 0.002 + number * 0.0005, csc, number)
        for cycle in range(20)
        for csc in range(1, 19)
        for number in range(1, 5)
        if (cycle, csc, number) != (9, 17, 3)
    ]
    result = judged(tmp_path, frames).result("period-gap")
    (gap,) = result.occurrences
    assert gap.subject.detail == "CSC 17 frame 3"
    assert frames[gap.order].data[:2] == bytes([3, 17])
    assert gap.start == pytest.approx(frames[gap.order].timestamp - frames[0].timestamp)
    assert result.examined == 18 * 4 * 19 - 1


def test_the_charger_can_alone_lacks_nothing(tmp_path: Path) -> None:
    frames = every(0.5, 0, 10, B2C_Charger) + every(0.5, 0.2, 10.2, C2B_ACStatus)
    judgement = judged(tmp_path, frames)
    assert not found(judgement)
    assert judgement.result("message-missing").status is Status.PASSED


def test_messages_to_tms_and_charger_are_missed_only_where_these_send(tmp_path: Path) -> None:
    frames = every(0.1, 0, 5, B2V_ST1)
    names = {subject for rule, _, subject in found(judged(tmp_path, frames))}
    assert names == {*MISSING, "B2V_ST2"}
    frames += every(1, 0, 5, TMS_BMS_0) + every(0.5, 0, 5, C2B_ACStatus)
    names = {subject for rule, _, subject in found(judged(tmp_path, frames))}
    assert names == {*MISSING, "B2V_ST2", "BMS_TMS_0", "B2C_Charger"}


def test_energies_are_missed_only_after_three_of_their_long_periods(tmp_path: Path) -> None:
    for seconds, missed in ((29.9, False), (30.2, True)):
        judgement = judged(tmp_path, every(0.1, 0, seconds, B2V_ST1))
        about = ("message-missing", "BMU", B2V_ElecEnergy.NAME)
        assert (about in found(judgement)) is missed


def test_a_vin_that_is_asked_for_each_time_is_no_repetition(tmp_path: Path) -> None:
    answers = every(0.5, 0.01, 10.01, V2B_VIN, bytes([1, *b"LCDEMTR"]))
    about = ("event-repeated", "VCU", "V2B_VIN frame 1")
    requests = every(0.5, 0, 10, B2V_RQ, bytes([0x09, 0, 0, 0, 0, 0, 0, 0]))
    for block in (0, 1):
        assert about in found(judged(tmp_path, answers, block))
        assert about not in found(judged(tmp_path, answers + requests, block))


def test_a_charger_that_is_unplugged_may_fall_silent(tmp_path: Path) -> None:
    charging = bytes([0x60, 0x03, 0xDC, 0, 0, 0, 0, 0])
    plugged = bytes([0x29, 0x20, 0x09, 0, 0, 0, 0, 0])
    frames = every(0.5, 0, 2, C2B_ACStatus, charging) + every(0.1, 0, 3, B2V_ST1, plugged)
    silent = frames + every(0.1, 3.1, 6, B2V_ST1, plugged)
    pulled = frames + every(0.1, 3.1, 6, B2V_ST1, HV_CLOSED)
    # Plugged in again, and the charger comes back.
    again = every(0.1, 6.1, 8, B2V_ST1, plugged) + every(0.5, 7, 8, C2B_ACStatus, charging)
    about = ("node-silence", "CHG", "")
    for block in (0, 1, 20):
        assert about in found(judged(tmp_path, silent + again, block))
        assert about not in found(judged(tmp_path, pulled + again, block))
        assert about in found(judged(tmp_path, silent, block))
        assert about not in found(judged(tmp_path, pulled, block))


def test_a_pack_with_uneven_cscs_loads_the_bus_as_its_cells_need(tmp_path: Path) -> None:
    # 24 cells on 4 CSCs: 4, 4, 4 and 12 make 2 + 2 + 2 + 4 frames; 6 each would make 2 each.
    totals = frame(0, B2V_BattInfo2, bytes([4, 24, 0, 24, 0, 0, 0, 0]))
    keys = [(csc, number) for csc in (1, 2, 3) for number in (1, 2)]
    keys += [(4, number) for number in (1, 2, 3, 4)]

    def cells(keys: list[tuple[int, int]]) -> list[can.Message]:
        return [
            each
            for csc, number in keys
            for each in every(0.1, 0, 10, B2V_Ucell, bytes([number, csc, 0, 0, 0, 0, 0, 0]))
        ]

    assert judged(tmp_path, [totals, *cells(keys)]).result("bus-load").status is Status.PASSED
    # No split of 24 cells over 4 CSCs needs more than 10 frames.
    more = [*keys, *((5, number) for number in range(1, 5))]
    assert judged(tmp_path, [totals, *cells(more)]).result("bus-load").status is Status.FAILED


def test_a_request_for_data_that_ends_is_no_gap(tmp_path: Path) -> None:
    frames = every(0.1, 0, 1, B2V_BattInfo2) + every(0.1, 2, 3, B2V_BattInfo2)
    lost = [each for each in frames if each.timestamp != pytest.approx(2.5)]
    assert ("period-gap", "BMU", "B2V_BattInfo2") not in found(judged(tmp_path, frames))
    assert found(judged(tmp_path, lost))["period-gap", "BMU", "B2V_BattInfo2"] == 1


def test_what_is_asked_for_anew_at_once_is_neither_a_gap_nor_too_early(tmp_path: Path) -> None:
    # RQSysCode are bits 10 and 11, 1 asks, 2 withdraws; byte 0 is the XOR of the others.
    ask, withdraw = (bytes([code << 2, code << 2, *bytes(6)]) for code in (1, 2))
    answers = [0.1, 1.1, 2.8, 3.8, 4.2, 5.2]
    frames = [frame(time, B2V_SysCode1) for time in answers]
    told = [frame(1.2, V2B_RQData, withdraw), frame(3.9, V2B_RQData, withdraw)]
    told += [frame(time, V2B_RQData, ask) for time in (0.0, 2.7, 4.1)]
    for block in (0, 1, 3):
        judgement = judged(tmp_path, [*told, *frames], block)
        # Steps of 1.7 s and of 0.4 s, which nothing excuses where the requests are not in the log.
        unasked = judged(tmp_path, frames, block)
        for rule in ("period-gap", "period-short"):
            assert (judgement.result(rule).examined, judgement.result(rule).count) == (3, 0)
            assert (unasked.result(rule).examined, unasked.result(rule).count) == (5, 1)


def test_a_command_before_any_other_frame_of_the_vcu_is_not_judged(tmp_path: Path) -> None:
    on = bytes([0x10, 0x10, 0, 0, 0, 0, 0, 0])
    result = judged(tmp_path, every(0.05, 0, 1, V2B_CMD, on)).result("relays-before-command")
    assert result.status is Status.NOT_JUDGED
