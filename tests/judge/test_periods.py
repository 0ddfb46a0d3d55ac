"""How regularly messages came: against the statistics module and a loop over all steps."""

from __future__ import annotations

import statistics
from itertools import pairwise
from pathlib import Path
from random import Random

import can
import numpy as np
import pytest
from rules.recorded import written

from swapcan.conform import Judge
from swapcan.messages import B2V_ST1, BSU_BMS_0, V2B_CMD, B2V_BattInfo1, B2V_Temp, B2V_Ucell
from typedcan.judge.measure.periods import COLUMNS, Periods
from typedcan.logs.read import open_log
from typedcan.wire.message import Message


def frame(time: float, message: type[Message], data: bytes = bytes(8)) -> can.Message:
    return can.Message(timestamp=time, arbitration_id=message.FRAME_ID, data=data, channel="can0")


def measured(frames: list[can.Message], path: Path, block: int = 100_000) -> list[Periods]:
    log = written(sorted(frames, key=lambda each: each.timestamp), path / "log.log")
    judge = Judge(rules=[])
    with open_log(log, block) as source:
        for each in source:
            judge.feed(each)
    return list(judge.finish().periods)


def uneven(count: int, period: float, seed: int) -> list[float]:
    """Times in whole microseconds, as a log has them."""
    random = Random(seed)
    times = [0.0]
    for _ in range(count):
        times.append(round(times[-1] + period * random.uniform(0.5, 1.5), 6))
    return times


def test_mean_and_deviation_are_those_of_the_steps(tmp_path: Path) -> None:
    times = uneven(3000, 0.05, 1)
    steps = [after - before for before, after in pairwise(times)]
    for block in (100_000, 7):
        (found,) = measured([frame(time, V2B_CMD) for time in times], tmp_path, block)
        assert (found.message, found.period, found.frames) == ("V2B_CMD", 0.05, 3001)
        assert found.mean == pytest.approx(statistics.fmean(steps), rel=1e-9)
        assert found.deviation == pytest.approx(statistics.pstdev(steps), rel=1e-9)
        assert found.shortest == pytest.approx(min(steps))
        assert found.longest == pytest.approx(max(steps))


@pytest.mark.parametrize("count", [50, 3000, 40_000])
def test_spans_show_the_extremes_of_each_and_lose_none(count: int, tmp_path: Path) -> None:
    times = uneven(count, 0.05, 2)
    (found,) = measured([frame(time, V2B_CMD) for time in times], tmp_path)
    assert len(found.time) <= COLUMNS
    if count > 3000:
        assert len(found.time) > COLUMNS // 3
    span = float(np.diff(found.time).min())
    ends, steps = np.array(times[1:]), np.diff(times)
    for middle, low, high in zip(found.time, found.low, found.high, strict=True):
        own = steps[(middle - span / 2 <= ends) & (ends < middle + span / 2)]
        assert low == pytest.approx(own.min())
        assert high == pytest.approx(own.max())
    assert found.low.min() == pytest.approx(found.shortest)
    assert found.high.max() == pytest.approx(found.longest)


def test_a_log_of_days_takes_as_few_spans(tmp_path: Path) -> None:
    times = [3600.0 * hour + 0.1 * number for hour in range(100) for number in range(3)]
    (found,) = measured([frame(time, BSU_BMS_0) for time in times], tmp_path, 64)
    assert 0 < len(found.time) <= COLUMNS
    # The hours between are silences of the node: two steps of 0.1 s each hour are left.
    assert found.longest == pytest.approx(0.1, abs=1e-6)


def test_frames_of_a_cycle_are_compared_with_those_of_the_same_number(tmp_path: Path) -> None:
    frames = [
        frame(round(cycle * period + 0.001 * csc + 0.0003 * number, 6), message, data)
        for message, period, numbers in ((B2V_Ucell, 0.1, 4), (B2V_Temp, 0.2, 2))
        for cycle in range(10)
        for csc in range(1, 4)
        for number in range(1, numbers + 1)
        for data in (bytes([number, csc, 0, 0, 0, 0, 0, 0]),)
    ]
    for block in (100_000, 5):
        cells, probes = measured(frames, tmp_path, block)
        for found, period, count in ((cells, 0.1, 120), (probes, 0.2, 60)):
            assert (found.period, found.frames) == (period, count)
            assert found.shortest == pytest.approx(period)
            assert found.longest == pytest.approx(period)


def test_silences_and_ends_of_requests_are_no_steps(tmp_path: Path) -> None:
    status = [0.0, 0.1, 0.2, 5.0, 5.1]
    asked = [0.05, 0.15, 5.05, 5.15, 5.55]
    frames = [frame(time, B2V_ST1) for time in status] + [
        frame(time, B2V_BattInfo1) for time in asked
    ]
    for block in (100_000, 1):
        info, own = measured(frames, tmp_path, block)
        assert (info.message, own.message) == ("B2V_BattInfo1", "B2V_ST1")
        assert own.longest == pytest.approx(0.1)
        assert info.longest == pytest.approx(0.1)
        assert own.frames == 5


def test_a_single_frame_has_no_steps(tmp_path: Path) -> None:
    (found,) = measured([frame(1, B2V_ST1)], tmp_path)
    assert found.frames == 1
    assert np.isnan([found.mean, found.deviation, found.shortest, found.longest]).all()
    assert len(found.time) == len(found.low) == len(found.high) == 0
