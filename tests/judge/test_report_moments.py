"""What a second look into a log finds around an occurrence."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from judge.report_samples import PLAIN, result, rule

from swapcan.conform import Judgement, Occurrence, Severity, Subject, judge_log
from swapcan.messages import B2V_Ucell
from typedcan.judge.measure.steps import frame_of_cycle
from typedcan.judge.report import moments
from typedcan.report.language import Text

BEGIN = 1_700_000_000.0
ST1, ST2, CMD, UCELL = "1881D0F3", "1882D0F3", "1802F3D0", f"{B2V_Ucell.FRAME_ID:08X}"

Line = tuple[float, str, str, str]
"""Time, channel, identifier and payload."""


def log(path: Path, lines: Iterable[Line], begin: float = BEGIN) -> Path:
    text = "".join(
        f"({begin + time:.6f}) {channel} {identifier}#{data}\n"
        for time, channel, identifier, data in lines
    )
    path.write_text(text, "ascii")
    return path


def state_of_charge(raw: int) -> str:
    """A B2V_ST2 whose first byte, 0.4 % a step, is this one."""
    return f"{raw:02X}00000000000000"


def found(subject: Subject, start: float, end: float = 0.0, measure: float = 0.0) -> Occurrence:
    text = Text("wrong", "错误")
    return Occurrence(
        subject=subject, start=start, end=end or start, order=0, measure=measure, text=text
    )


def judged(*occurrences: Occurrence, severity: Severity = Severity.MUST) -> Judgement:
    results = (result(rule("some-rule", severity), *occurrences),)
    return replace(PLAIN, begin=BEGIN, seconds=20.0, results=results)


def test_a_signal_is_shown_from_a_second_before_to_a_second_after(tmp_path: Path) -> None:
    lines = [(i / 10, "can0", ST2, state_of_charge(i)) for i in range(200)]
    path = log(tmp_path / "a.log", lines)
    subject = Subject("BMU", "B2V_ST2", "B2V_ST2_SOC")
    (moment,) = moments(path, judged(found(subject, 5.05, 5.25)))
    assert (moment.rule, moment.begin, moment.end) == ("some-rule", 4.05, 6.25)
    (track,) = moment.tracks
    assert (track.name, track.unit, track.labels) == ("B2V_ST2_SOC", "%", {})
    assert track.value is not None
    np.testing.assert_allclose(track.time, np.arange(41, 63) / 10, atol=1e-6)
    np.testing.assert_allclose(track.value, np.arange(41, 63) * 0.4)


def test_a_code_that_is_no_value_is_none(tmp_path: Path) -> None:
    lines = [(raw / 1000, "can0", ST2, state_of_charge(raw)) for raw in (10, 250, 0xFF)]
    path = log(tmp_path / "a.log", lines)
    (moment,) = moments(path, judged(found(Subject("BMU", "B2V_ST2", "B2V_ST2_SOC"), 0.1)))
    assert moment.tracks[0].value is not None
    np.testing.assert_allclose(moment.tracks[0].value, [4.0, 100.0, np.nan])


def test_codes_come_with_their_labels(tmp_path: Path) -> None:
    lines = [(0.0, "can0", CMD, "0000000000000000"), (0.05, "can0", CMD, "0000010000000000")]
    path = log(tmp_path / "a.log", lines)
    subject = Subject("VCU", "V2B_CMD", "V2B_CMD_HV_OnOff")
    (moment,) = moments(path, judged(found(subject, 0.05)))
    (track,) = moment.tracks
    assert len(track.labels) == 4
    assert track.value is not None
    assert set(track.value) <= set(track.labels)


def test_a_message_is_shown_by_its_frames_and_its_counter(tmp_path: Path) -> None:
    lines = [(i / 10, "can0", ST1, f"00F{i % 15:X}000000000000") for i in range(40)]
    path = log(tmp_path / "a.log", lines)
    (moment,) = moments(path, judged(found(Subject("BMU", "B2V_ST1"), 2.0)))
    frames, counter = moment.tracks
    assert (frames.name, frames.value) == ("B2V_ST1", None)
    np.testing.assert_allclose(frames.time, np.arange(10, 31) / 10, atol=1e-6)
    assert counter.name == "B2V_ST1_ALIV"
    assert counter.value is not None
    assert counter.value.tolist() == [i % 15 for i in range(10, 31)]


def test_of_a_cycle_only_the_frame_that_is_meant_is_shown(tmp_path: Path) -> None:
    places = [(csc, frame) for csc in (1, 2) for frame in (1, 2, 3)]
    lines = [
        (i / 100, "can0", UCELL, f"{frame:02X}{csc:02X}000000000000")
        for i, (csc, frame) in enumerate(places * 2)
    ]
    path = log(tmp_path / "a.log", lines)
    subject = Subject("BMU", "B2V_Ucell", "", frame_of_cycle(2 << 8 | 3))
    (moment,) = moments(path, judged(found(subject, 0.0)))
    (track,) = moment.tracks
    assert track.name == "B2V_Ucell CSC 2 frame 3"
    np.testing.assert_allclose(track.time, [0.05, 0.11], atol=1e-6)


def test_a_signal_that_is_named_beside_is_shown_too(tmp_path: Path) -> None:
    path = log(tmp_path / "a.log", [(0.0, "can0", ST2, state_of_charge(1))])
    subject = Subject("BMU", "B2V_ST2", "B2V_ST2_SOC", "V2B_CMD_HV_OnOff")
    (moment,) = moments(path, judged(found(subject, 0.0)))
    assert [track.name for track in moment.tracks] == ["B2V_ST2_SOC", "V2B_CMD_HV_OnOff"]


def test_a_node_is_shown_by_what_it_always_sends(tmp_path: Path) -> None:
    path = log(tmp_path / "a.log", [(0.0, "can0", CMD, "0000000000000000")])
    (moment,) = moments(path, judged(found(Subject("VCU"), 0.0)))
    assert [track.name for track in moment.tracks] == ["V2B_CMD"]
    assert moment.tracks[0].time.tolist() == [0.0]


def test_what_is_not_on_the_bus_is_shown_empty(tmp_path: Path) -> None:
    path = log(tmp_path / "a.log", [(0.0, "can0", CMD, "0000000000000000")])
    subjects = (Subject("BMU", "B2V_ST2", "B2V_ST2_SOC"), Subject("BMU", "B2V_ST3"))
    for subject in subjects:
        (moment,) = moments(path, judged(found(subject, 0.0)))
        assert [len(track.time) for track in moment.tracks] == [0]
    (unknown,) = moments(path, judged(found(Subject("BMU", "no such message"), 0.0)))
    assert unknown.tracks == ()


def test_only_frames_that_were_judged_are_shown(tmp_path: Path) -> None:
    lines = [
        (-0.5, "can1", ST2, state_of_charge(1)),  # before what was judged
        (0.0, "can0", ST2, state_of_charge(2)[:8]),  # too short
        (0.1, "can0", ST2, state_of_charge(3)),
        (0.2, "can1", ST2, state_of_charge(4)),  # on another channel than the first
        (0.3, "can0", ST2, state_of_charge(5)),
        (30.0, "can0", ST2, state_of_charge(6)),  # behind what was judged
    ]
    path = log(tmp_path / "a.log", lines)
    (moment,) = moments(path, judged(found(Subject("BMU", "B2V_ST2", "B2V_ST2_SOC"), 0.0, 40.0)))
    assert moment.tracks[0].value is not None
    np.testing.assert_allclose(moment.tracks[0].value, [1.2, 2.0])
    assert moment.end == 20.0


def test_a_long_occurrence_is_cut(tmp_path: Path) -> None:
    path = log(tmp_path / "a.log", [(0.0, "can0", ST2, state_of_charge(1))])
    long = replace(judged(found(Subject("BMU", "B2V_ST2"), 2.0, 900.0)), seconds=1000.0)
    (moment,) = moments(path, long)
    assert (moment.begin, moment.end) == (1.0, 33.0)


def test_a_flood_is_thinned_and_its_peak_stays(tmp_path: Path) -> None:
    lines = [
        (i / 10_000, "can0", ST2, state_of_charge(200 if i == 7_777 else 100))
        for i in range(10_000)
    ]
    path = log(tmp_path / "a.log", lines)
    (moment,) = moments(path, judged(found(Subject("BMU", "B2V_ST2", "B2V_ST2_SOC"), 0.5)))
    (track,) = moment.tracks
    assert track.value is not None
    assert 1000 <= len(track.time) == len(track.value) <= 2000
    assert (np.diff(track.time) > 0).all()
    assert track.time[track.value == 80.0].tolist() == [pytest.approx(0.7777)]


def test_the_first_and_the_worst_of_each_rule_demands_first(tmp_path: Path) -> None:
    path = log(tmp_path / "a.log", [(0.0, "can0", ST2, state_of_charge(1))])
    subject = Subject("BMU", "B2V_ST2")
    times = {"should-a": 1.0, "must-b": 2.0, "must-c": 3.0}
    results = tuple(
        result(
            rule(id_, Severity.SHOULD if id_.startswith("should") else Severity.MUST),
            found(subject, time, measure=1.0),
            found(subject, time + 0.5, measure=2.0),
        )
        for id_, time in times.items()
    )
    note = result(rule("note-d", Severity.INFO), found(subject, 9.0))
    judgement = replace(judged(), results=(*results, note))

    def shown(most: int) -> list[tuple[str, float]]:
        taken = moments(path, judgement, most=most)
        return [(each.rule, each.occurrence.start) for each in taken]

    everything = [
        ("must-b", 2.0),
        ("must-b", 2.5),
        ("must-c", 3.0),
        ("must-c", 3.5),
        ("should-a", 1.0),
        ("should-a", 1.5),
    ]
    assert shown(12) == everything
    assert shown(3) == everything[:3]
    assert shown(2) == [("must-b", 2.0), ("must-c", 3.0)]


def test_a_log_without_dates_and_without_findings(tmp_path: Path) -> None:
    lines = [(i / 10, "can0", ST2, state_of_charge(i)) for i in range(100)]
    path = log(tmp_path / "a.log", lines, begin=3.0)
    judgement = replace(judged(found(Subject("BMU", "B2V_ST2"), 5.0)), begin=3.0)
    (moment,) = moments(path, judgement)
    assert moment.tracks[0].time[0] == pytest.approx(4.0)
    assert moments(tmp_path / "there is no such log", judged()) == ()


def test_a_judged_log_shows_the_frames_that_were_found(tmp_path: Path) -> None:
    good, bad = "F8F0000800000000", "F9F1000800000000"  # the bytes of both make 0xF8 and 0xF9
    lines = [(0.0, "can0", ST1, good), (0.1, "can0", ST1, "00F1000800000000")]
    path = log(tmp_path / "a.log", [*lines, (0.2, "can0", ST1, bad)])
    judgement = judge_log(path)
    (moment,) = [each for each in moments(path, judgement) if each.rule == "checksum"]
    assert moment.occurrence.start in moment.tracks[0].time
    np.testing.assert_allclose(moment.tracks[0].time, [0.0, 0.1, 0.2], atol=1e-6)
