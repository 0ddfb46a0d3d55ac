"""How a log is judged, whatever the rules: chunks, channels, verdicts, what is kept."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import can
import numpy as np
import pytest
from rules.altered import byte, lost
from rules.recorded import recorded, written

from swapcan.conform import (
    RULES,
    ConformError,
    Judge,
    Judgement,
    Rule,
    Severity,
    Status,
    Subject,
    Verdict,
    judge_log,
)
from swapcan.messages import B2V_ST0, B2V_ST1, B2V_ST2
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import KEPT, Findings, Occurrence
from typedcan.judge.rule import Watcher
from typedcan.judge.series import latest
from typedcan.logs.frames import FrameBlock
from typedcan.logs.read import open_log
from typedcan.report.language import Text

PLAN = "hv_on@0.5s, ask@1s, drive@2s+8s, charge@14s+8s, hv_off@26s"
SOC = Text("SOC is {soc}", "SOC 为 {soc}")


class SocIsEven(Watcher):
    """A rule of no standard: raw SOC is even."""

    def feed(self, chunk: Chunk) -> None:
        """Judge the frames of B2V_ST2."""
        series = chunk.sound(B2V_ST2)
        soc = series.raw("soc")
        self.findings.rows(
            Subject("BMU", "B2V_ST2", "B2V_ST2_SOC"),
            series,
            soc % 2 == 1,
            lambda row: (SOC, {"soc": int(soc[row])}),
            measure=soc,
        )


def rule(severity: Severity = Severity.MUST, watch: type[Watcher] = SocIsEven) -> Rule:
    return Rule(
        id="soc-even",
        title=SOC,
        purpose=SOC,
        clause="none",
        severity=severity,
        judges=("BMU",),
        watch=watch,
    )


def soc_frames(*socs: int) -> list[can.Message]:
    """B2V_ST2 every 100 ms with these raw values of its first byte."""
    return [
        can.Message(
            timestamp=number / 10,
            arbitration_id=0x1882D0F3,
            data=bytes([soc, 0, 16, 39, 0, 0, 0, 0]),
            channel="can0",
        )
        for number, soc in enumerate(socs)
    ]


def judged(
    frames: Iterable[can.Message], folder: Path, *rules: Rule, size: int = 1 << 16
) -> Judgement:
    """What a log of these frames gives, taken so many at a time."""
    judge = Judge(rules=rules)
    with open_log(written(frames, folder / "case.log"), size) as log:
        for block in log:
            judge.feed(block)
    return judge.finish()


@pytest.mark.parametrize("size", [1, 2, 3, 100])
def test_wrong_frames_in_a_row_are_one_occurrence_wherever_the_log_is_cut(
    size: int, tmp_path: Path
) -> None:
    frames = soc_frames(2, 3, 7, 5, 4, 9, 6)
    result = judged(frames, tmp_path, rule(), size=size).result("soc-even")
    found = [
        (each.start, each.end, each.order, each.frames, each.says()) for each in result.occurrences
    ]
    assert found == [(0.1, 0.3, 1, 3, "SOC is 7"), (0.5, 0.5, 5, 1, "SOC is 9")]
    assert (result.examined, result.count, result.frames) == (7, 2, 4)
    assert result.worst == result.occurrences[1]
    assert result.first == result.occurrences[0]


def test_more_occurrences_than_are_kept_are_counted(tmp_path: Path) -> None:
    frames = soc_frames(*(2, 3) * (KEPT + 5), 99)
    result = judged(frames, tmp_path, rule(), size=300).result("soc-even")
    assert len(result.occurrences) == KEPT
    assert result.count == KEPT + 5
    assert result.worst
    assert result.worst.says() == "SOC is 99"


def test_a_must_decides_the_verdict_and_a_should_or_an_info_does_not(tmp_path: Path) -> None:
    frames = soc_frames(3)
    verdicts = {}
    for severity in Severity:
        judgement = judged(frames, tmp_path, rule(severity))
        verdicts[severity] = (judgement.verdict, judgement.result("soc-even").status)
    assert verdicts == {
        Severity.MUST: (Verdict.VIOLATES, Status.FAILED),
        Severity.SHOULD: (Verdict.CONFORMS, Status.FAILED),
        Severity.INFO: (Verdict.CONFORMS, Status.NOTED),
    }


def test_a_node_that_is_not_in_the_log_could_not_be_judged(tmp_path: Path) -> None:
    log = written(soc_frames(2), tmp_path / "pack.log")
    assert judge_log(log, ["BMU"], rules=[rule()]).verdict is Verdict.CONFORMS
    judgement = judge_log(log, ["VCU"], rules=[rule()])
    assert judgement.verdict is Verdict.NOT_JUDGED
    assert judgement.result("soc-even").status is Status.NOT_JUDGED


def test_nobody_is_blamed_who_is_not_judged(tmp_path: Path) -> None:
    log = written(soc_frames(3), tmp_path / "pack.log")
    assert judge_log(log, ["VCU"], rules=[rule()]).result("soc-even").count == 0


def test_a_message_is_judged_on_the_channel_on_which_it_came_first(tmp_path: Path) -> None:
    frames = soc_frames(2, 3, 4)
    frames[1].channel = "can1"
    result = judged(frames, tmp_path, rule()).result("soc-even")
    assert (result.examined, result.count) == (2, 0)


def test_frames_of_another_kind_or_length_are_not_taken_for_the_message(tmp_path: Path) -> None:
    frames = soc_frames(2, 3, 3)
    frames[1].data, frames[1].dlc = bytearray(7), 7
    frames[2].is_remote_frame, frames[2].data = True, bytearray()
    with can.ASCWriter(tmp_path / "case.asc") as writer:
        for frame in frames:
            writer.on_message_received(frame)
    result = judge_log(tmp_path / "case.asc", rules=[rule()]).result("soc-even")
    assert (result.examined, result.count) == (1, 0)


def test_unknown_nodes_and_tolerances_are_refused_by_name() -> None:
    with pytest.raises(ConformError, match="no node 'BMS'; known: BMU, VCU, CHG, TMS, BSU"):
        Judge(["BMS"])
    with pytest.raises(ConformError, match=r"no tolerance 'soc.share'; known: "):
        Judge(limits={"soc.share": 1.0})


class Latest(Watcher):
    """Notes the relays that were told last before each B2V_ST1."""

    found: list[int]

    def feed(self, chunk: Chunk) -> None:
        """Look back from each new row."""
        at, of = chunk.sound(B2V_ST1), chunk.sound(B2V_ST0)
        places = latest(of, at)[at.first :]
        relays = of.raw("st_main_pos")
        self.found += [int(relays[place]) if place >= 0 else -1 for place in places]


@pytest.mark.parametrize("size", [1, 2, 100])
def test_the_latest_row_is_the_one_before_in_the_log_across_chunks(
    size: int, tmp_path: Path
) -> None:
    def frame(number: int, data: str) -> can.Message:
        # All at one time: the order in the log decides.
        return can.Message(arbitration_id=number, data=bytes.fromhex(data), channel="can0")

    st1, opened, closed = 0x1881D0F3, "0010000000000000", "0020000000000000"
    frames = [
        frame(st1, "0000000000000000"),
        frame(0x1880D0F3, opened),
        frame(st1, "0101000000000000"),
        frame(st1, "0202000000000000"),
        frame(0x1880D0F3, closed),
        frame(st1, "0303000000000000"),
    ]
    made: list[Latest] = []

    class Made(Latest):
        def __init__(self, findings: Findings) -> None:
            super().__init__(findings)
            self.found = []
            made.append(self)

    judged(frames, tmp_path, rule(watch=Made), size=size)
    assert made[0].found == [-1, 1, 1, 2]


def occurrences(judgement: Judgement) -> dict[str, list[Occurrence]]:
    """All that was found, by rule."""
    return {result.rule.id: list(result.occurrences) for result in judgement.results}


def rounded(found: dict[str, list[Occurrence]]) -> dict[str, list[tuple[object, ...]]]:
    """What must be the same however sums are made."""
    return {
        rule_id: [
            (each.subject, round(each.start, 6), round(each.end, 6), each.order, each.frames)
            for each in all_of_it
        ]
        for rule_id, all_of_it in found.items()
    }


@pytest.mark.parametrize("size", [97, 1000])
def test_all_rules_find_the_same_wherever_a_log_is_cut(size: int, tmp_path: Path) -> None:
    frames = recorded(PLAN, "BMU.wrong_checksum@5s+2s", "BMU.lost_frame@8s+2s", seconds=30.0)
    frames = byte("B2V_ST2", 9.0, 0, 0xFF)(lost("B2V_ST1", 12.0)(frames))
    whole = judged(frames, tmp_path, *RULES)
    cut = judged(frames, tmp_path, *RULES, size=size)
    assert rounded(occurrences(cut)) == rounded(occurrences(whole))
    assert {r.rule.id: r.examined for r in cut.results} == {
        r.rule.id: r.examined for r in whole.results
    }


def test_a_log_whose_times_are_of_day_is_judged_as_one_that_begins_at_zero(tmp_path: Path) -> None:
    frames = recorded(PLAN, "BMU.lost_frame@8s+2s", seconds=30.0)
    now = judged(frames, tmp_path, *RULES)
    later = [
        can.Message(
            timestamp=frame.timestamp + 1_700_000_000,
            arbitration_id=frame.arbitration_id,
            data=frame.data,
            channel=frame.channel,
        )
        for frame in frames
    ]
    then = judged(later, tmp_path, *RULES)
    assert then.begin == pytest.approx(1_700_000_000, abs=1)
    found, same = rounded(occurrences(now)), rounded(occurrences(then))
    assert {key: len(value) for key, value in found.items()} == {
        key: len(value) for key, value in same.items()
    }


def test_an_empty_log_could_not_be_judged() -> None:
    judge = Judge()
    judge.feed(
        FrameBlock(
            np.empty(0),
            np.empty(0, np.uint32),
            np.empty(0, np.uint8),
            np.empty(0, np.int16),
            np.empty(0, np.uint8),
            np.empty((0, 8), np.uint8),
            (),
        )
    )
    judgement = judge.finish()
    assert judgement.verdict is Verdict.NOT_JUDGED
    assert {result.status for result in judgement.results} == {Status.NOT_JUDGED}
