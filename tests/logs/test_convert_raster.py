"""The raster: at each point the last value before, worked out here frame by frame."""

from __future__ import annotations

import math
from fractions import Fraction
from pathlib import Path
from typing import Any

import can
import pytest
from logs.table_logs import START, own_database, traffic, write_frames

import swapcan
from swapcan.logs import tables
from swapcan.messages import B2V_RQ, B2V_ST2, MESSAGES
from typedcan.logs import pipeline
from typedcan.logs.pipeline import Layout, Options
from typedcan.logs.raster import RasterError, raster_step

_STEP = Fraction(1, 10)


def _raster(log: Path, step: Fraction = _STEP, **more: Any) -> dict[str, list[Any]]:
    options = Options(layout=Layout.RASTER, step=step, **more)
    return tables(log, options=options)["raster"].to_pydict()


def _points(frames: list[can.Message], step: Fraction) -> list[float]:
    first = math.ceil(Fraction(frames[0].timestamp) / step)
    last = math.floor(Fraction(frames[-1].timestamp) / step)
    return [float(number * step) for number in range(first, last + 1)]


@pytest.mark.parametrize("block", [50, 1000, 1 << 17])
@pytest.mark.parametrize("step", [Fraction(1, 10), Fraction(7, 1000)])
def test_each_point_has_the_last_value_at_or_before_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, block: int, step: Fraction
) -> None:
    monkeypatch.setattr(pipeline, "_BLOCK", block)
    frames = traffic(6)
    log = write_frames(tmp_path / "x.log", frames)
    found = _raster(log, step)
    points = _points(frames, step)
    assert found.pop("timestamp") == points
    database = own_database()
    for kind in MESSAGES:
        own = [frame for frame in frames if frame.arbitration_id == kind.FRAME_ID]
        values: list[Any] = [
            database.decode_message(kind.FRAME_ID, bytes(frame.data), decode_choices=False)
            for frame in own
        ]
        lasting = 5 * (kind.PERIOD or math.inf)
        for part in kind.FIELDS.values():
            codes = {code * part.factor + part.offset for code in part.states}
            expected: list[Any] = []
            at = -1
            for point in points:
                while at + 1 < len(own) and own[at + 1].timestamp <= point:
                    at += 1
                fresh = at >= 0 and point - own[at].timestamp <= lasting
                value = values[at][part.dbc_name] if fresh else None
                expected.append(None if value in codes else value)
            assert found[part.dbc_name] == expected


def test_a_value_lasts_five_periods_and_no_longer(tmp_path: Path) -> None:
    assert B2V_ST2.PERIOD == 0.1
    frames = [
        can.Message(START + t, B2V_ST2.FRAME_ID, data=swapcan.encode(B2V_ST2(soc=40)))
        for t in (0.05, 2.05)
    ]
    found = _raster(
        write_frames(tmp_path / "x.log", frames), signals=("SOC",), messages=("B2V_ST2",)
    )
    assert found["B2V_ST2_SOC"] == [40] * 5 + [None] * 15
    assert found["B2V_ST2_SOC.state"] == ["value"] * 5 + [None] * 15


def test_a_message_without_a_period_keeps_its_value(tmp_path: Path) -> None:
    assert B2V_RQ.PERIOD is None
    data = swapcan.encode(B2V_RQ())
    frames = [can.Message(START + t, B2V_RQ.FRAME_ID, data=data) for t in (0, 60)]
    log = write_frames(tmp_path / "x.log", frames)
    column = next(iter(B2V_RQ.FIELDS.values())).dbc_name
    found = _raster(log, messages=("B2V_RQ",))[column]
    assert len(found) == 601
    assert len(set(found)) == 1


def test_a_long_silence_makes_no_rows(tmp_path: Path) -> None:
    data = swapcan.encode(B2V_ST2(soc=40))
    times = (START, START + 1, START + 100_000, START + 100_001)
    frames = [can.Message(t, B2V_ST2.FRAME_ID, data=data) for t in times]
    found = _raster(write_frames(tmp_path / "x.log", frames), Fraction(1))
    assert found["timestamp"] == list(times)


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("100ms", Fraction(1, 10)),
        ("0.5 s", Fraction(1, 2)),
        ("1min", 60),
        ("250us", Fraction(1, 4000)),
    ],
)
def test_a_raster_is_a_number_and_a_unit(text: str, seconds: Fraction) -> None:
    assert raster_step(text) == seconds


@pytest.mark.parametrize("text", ["", "100", "0ms", "-1s", "1h", "ms"])
def test_anything_else_is_no_raster(text: str) -> None:
    with pytest.raises(RasterError, match="100ms"):
        raster_step(text)
