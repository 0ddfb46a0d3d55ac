"""`swapcan monitor` where there is no terminal: lines, JSON, recording, errors, interruption."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from uuid import uuid4

import can
import pytest
from monitor.monitored import frame

from swapcan import cli
from typedcan.commands import monitor


@pytest.fixture
def bus() -> Iterator[list[str]]:
    """The options of a virtual bus on which the pack sends its state, and another protocol."""
    channel = f"test-{uuid4()}"
    with can.Bus(channel, "virtual", ignore_config=True) as sender:
        sender.send_periodic(frame("B2V_ST2", 0, SOC=80, Current=100), 0.1)
        sender.send_periodic(frame("B2V_ST3", 0, Upack_Batt=600), 0.1)
        sender.send_periodic(frame("B2V_ST1", 0, BMS=2, Flt_OverTemp=1), 0.1)
        sender.send_periodic(can.Message(arbitration_id=0x18FEF100), 0.1)
        yield ["-i", "virtual", "-c", channel]
        sender.stop_all_periodic_tasks()


def test_lines_tell_what_happens_and_sum_up(
    bus: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.run(["monitor", *bus, "--seconds", "1", "--interval", "0.4"]) == 0
    out, errors = capsys.readouterr()
    lines = [re.fullmatch(r" *\d+\.\d{3}  (.+)", line) for line in out.splitlines()]
    texts = [line[1] for line in lines if line]
    assert len(texts) == len(lines)
    assert "B2V_ST2: never seen -> alive" in texts
    assert "B2V_ST1.flt_over_temp: alarm: Level 1-Light fault" in texts
    # The counter stands still: told once in each interval, not for each frame.
    repeated = [text for text in texts if text.startswith("B2V_ST1: counter")]
    summaries = [text for text in texts if " frames, " in text]
    assert 1 <= len(repeated) <= len(summaries)
    assert len(summaries) == 3
    assert "1 foreign identifiers, 1 alarms, SOC 80 %, inside 600 V, current 100 A" in summaries[1]
    assert errors.startswith("swapcan: monitoring ")


def test_json_has_one_object_an_interval(
    bus: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["--json", "--seconds", "1", "--interval", "0.4", "--filter", "st2"]
    assert cli.run(["monitor", *bus, *arguments]) == 0
    objects = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert len(objects) == 3
    told = objects[1]
    assert (told["bus_lost"], told["recording"]) == (None, None)
    (message,) = told["messages"]
    assert (message["name"], message["state"], message["frame_id"]) == (
        "B2V_ST2",
        "alive",
        0x1882D0F3,
    )
    assert message["last"]["signals"]["B2V_ST2_SOC"] == 80.0
    assert told["pack"]["items"]["power"]["value"] == 60.0
    assert told["pack"]["alarms"][0]["signal"] == "B2V_ST1_Flt_OverTemp"
    assert told["foreign"][0]["frame_id"] == 0x18FEF100
    assert objects[2]["totals"]["frames"] > objects[0]["totals"]["frames"]


def test_it_ends_after_a_count_of_messages_and_has_recorded_all(
    bus: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "drive.blf"
    assert cli.run(["monitor", *bus, "--count", "5", "--json", "--record", str(path)]) == 0
    out, errors = capsys.readouterr()
    told = json.loads(out.splitlines()[-1])
    assert told["totals"]["messages"] >= 5
    assert told["recording"]["file"] == str(path)
    with can.LogReader(path) as log:
        frames = len(list(log))
    assert frames >= told["totals"]["frames"]
    assert errors.splitlines()[-1] == f"swapcan: {path}: recorded {frames} frames"


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (["--record", "drive.xyz"], "drive.xyz: python-can writes no .xyz; it writes .asc, "),
        (["--record", "gone/drive.blf"], "drive.blf: cannot be written: "),
        (["--interval", "0"], "expected a positive number of seconds, not '0'"),
        (["--count", "some"], "expected a positive whole number, not 'some'"),
    ],
)
def test_what_the_user_can_mend_is_one_line(
    arguments: list[str],
    text: str,
    bus: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert cli.run(["monitor", *bus, *arguments]) == 2
    out, errors = capsys.readouterr()
    assert out == ""
    assert text in errors
    assert errors.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_without_textual_it_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(monitor, "_has_terminal", lambda: True)
    for name in [name for name in sys.modules if name.startswith("typedcan.monitor.view")]:
        monkeypatch.delitem(sys.modules, name)
    for name in [name for name in sys.modules if name.split(".")[0] == "textual"]:
        monkeypatch.setitem(sys.modules, name, None)
    monkeypatch.setitem(sys.modules, "textual", None)
    assert cli.run(["monitor", "-i", "virtual"]) == 2
    assert capsys.readouterr().err == (
        "swapcan: the view needs textual: pip install 'swapcan[monitor]'; --plain prints lines\n"
    )


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no signals for one process")
@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_an_interrupted_recording_is_closed(
    number: signal.Signals, status: int, tmp_path: Path, environment: dict[str, str]
) -> None:
    path = tmp_path / "drive.blf"
    with subprocess.Popen(
        [sys.executable, "-m", "swapcan", "monitor", "-i", "virtual", "--record", str(path)],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        encoding="utf-8",
    ) as process:
        assert process.stderr
        assert process.stderr.readline().startswith("swapcan: monitoring ")
        process.send_signal(number)
        _, errors = process.communicate(timeout=10)
    assert process.returncode == status
    assert errors == f"swapcan: {path}: recorded 0 frames\n"
    with can.BLFReader(path) as log:
        assert log.file_size == path.stat().st_size
