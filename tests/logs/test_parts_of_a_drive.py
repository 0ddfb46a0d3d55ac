"""Several logs of one drive: put in order, their times going on; and what is no such thing."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
import pytest
from logs.table_logs import START, traffic, write_frames

from swapcan import cli

CASES = Path(__file__).parent / "other_programs"


def _convert(output: Path, *arguments: object) -> int:
    return cli.run(["convert", *map(str, arguments), "-o", str(output)])


def _times(path: Path) -> list[float]:
    times: Any = pq.read_table(path).column("timestamp").to_pylist()
    return list(times)


@pytest.mark.parametrize("jobs", [1, 2])
@pytest.mark.parametrize("order", [(1, 2), (2, 1)])
def test_two_parts_that_each_count_from_0_go_on(
    tmp_path: Path, order: tuple[int, int], jobs: int
) -> None:
    parts = [CASES / f"rotated-{number}.asc" for number in order]
    chosen = ("--messages", "B2V_ST2", "--jobs", jobs)
    assert _convert(tmp_path / "x.parquet", *parts, *chosen) == 0
    times = _times(tmp_path / "x.parquet")
    first, second = (
        _alone(tmp_path / f"{n}.parquet", CASES / f"rotated-{n}.asc", chosen) for n in (1, 2)
    )
    # Part 2 begins 2.456 s after part 1, as their trigger blocks say.
    assert times == pytest.approx([*first, *(2.456 + each for each in second)], abs=1e-6)


def _alone(output: Path, log: Path, chosen: tuple[object, ...]) -> list[float]:
    assert _convert(output, log, *chosen) == 0
    return _times(output)


@pytest.mark.parametrize("order", [(1, 2), (2, 1)])
def test_a_raster_never_runs_backwards(tmp_path: Path, order: tuple[int, int]) -> None:
    parts = [CASES / f"rotated-{number}.asc" for number in order]
    assert _convert(tmp_path / "x.parquet", *parts, "--raster", "100ms") == 0
    times = _times(tmp_path / "x.parquet")
    assert times == sorted(set(times))
    assert times[-1] - times[0] > 4.4


def test_logs_that_overlap_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    logs = [write_frames(tmp_path / f"{n}.blf", traffic(3, START + 2 * n)) for n in range(2)]
    assert _convert(tmp_path / "x.parquet", *reversed(logs), "--messages", "B2V_ST2") == 2
    assert "1.blf: begins 0.9" in (said := capsys.readouterr().err)
    assert "before 0.blf ends" in said
    assert not (tmp_path / "x.parquet").exists()


def test_logs_without_a_date_that_start_again_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    logs = [write_frames(tmp_path / f"{n}.log", traffic(1, 0.0)) for n in range(2)]
    assert _convert(tmp_path / "x.parquet", *logs, "--messages", "B2V_ST2", "--jobs", 1) == 2
    assert "1.log: begins" in capsys.readouterr().err


def test_a_wall_clock_is_that_of_the_zone_that_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = CASES / "trc-local-start.trc"
    part = ("--from", "2025-06-30T14:05:01", "--to", "2025-06-30T14:05:02")
    for zone in ("Asia/Shanghai", "UTC"):
        output = tmp_path / f"{zone[:3]}.parquet"
        chosen = ("--messages", "B2V_ST2", "--recorded-in", zone)
        assert _convert(output, log, *chosen, *part) == 0
        assert f"began 2025-06-30 14:05:00.000 {zone}" in capsys.readouterr().err
    there, here = _times(tmp_path / "Asi.parquet"), _times(tmp_path / "UTC.parquet")
    assert len(there) == len(here) == 10
    assert [b - a for a, b in zip(there, here, strict=True)] == pytest.approx([8 * 3600.0] * 10)


def test_a_zone_that_there_is_not_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = shutil.copy(CASES / "trc-local-start.trc", tmp_path)
    assert _convert(tmp_path / "x.parquet", log, "--recorded-in", "Asia/Peking") == 2
    assert "there is no time zone 'Asia/Peking'" in capsys.readouterr().err
