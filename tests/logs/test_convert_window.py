"""The part of a log between two moments."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import can
import pyarrow.parquet as pq
import pytest
from logs.table_logs import START, traffic, write_frames

from swapcan import cli
from swapcan.messages import B2V_ST2


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_frames(tmp_path_factory.mktemp("window") / "drive.blf", traffic(8))


def _run(*arguments: object) -> int:
    return cli.run(["convert", *map(str, arguments)])


def _times(path: Path) -> list[float]:
    times: Any = pq.read_table(path).column("timestamp").to_pylist()
    return list(times)


@pytest.mark.parametrize(
    ("arguments", "low", "high"),
    [
        (["--from", "2"], 2.0, 99.0),
        (["--to", "3.5"], 0.0, 3.5),
        (["--from", "2", "--to", "3.5"], 2.0, 3.5),
    ],
)
def test_a_part_is_chosen_by_seconds_since_the_begin(
    log: Path, tmp_path: Path, arguments: list[str], low: float, high: float
) -> None:
    _run(log, "-o", tmp_path / "x.parquet", "--messages", "B2V_ST2", *arguments)
    with can.LogReader(log) as reader:
        frames = list(reader)
    begin = frames[0].timestamp
    assert _times(tmp_path / "x.parquet") == [
        frame.timestamp
        for frame in frames
        if frame.arbitration_id == B2V_ST2.FRAME_ID
        and begin + low <= frame.timestamp <= begin + high
    ]


def test_a_part_is_chosen_by_date_and_time(log: Path, tmp_path: Path) -> None:
    # 1,700,000,000 s after 1970 is 2023-11-14T22:13:20Z.
    arguments = ("--from", "2023-11-14T22:13:22+00:00", "--to", "2023-11-15T06:13:23+08:00")
    _run(log, "-o", tmp_path / "x.parquet", "--messages", "B2V_ST2", *arguments)
    times = _times(tmp_path / "x.parquet")
    assert START + 2 <= min(times) < START + 2.2
    assert START + 2.8 < max(times) <= START + 3


@pytest.mark.parametrize("part", [["--from", "99"], ["--to", "2001-02-03"]])
def test_an_empty_part_says_what_the_log_spans_and_writes_nothing(
    log: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], part: list[str]
) -> None:
    assert _run(log, "-o", tmp_path / "x.parquet", "--recorded-in", "Asia/Shanghai", *part) == 2
    said = capsys.readouterr().err
    # the log's clock was UTC, as python-can writes it; who says another zone is believed
    assert "from 2023-11-14 22:13:20.000+08:00 to 2023-11-14 22:13:27.994+08:00" in said
    assert not [*tmp_path.iterdir()]


def test_dates_are_refused_where_times_count_from_the_begin(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = write_frames(tmp_path / "x.log", traffic(1, start=0.0))
    assert _run(log, "-o", tmp_path / "out", "--from", "2023-11-14") == 2
    assert "give seconds" in capsys.readouterr().err
