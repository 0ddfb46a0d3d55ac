"""`python -m typedcan --dbc FILE monitor`: lines and JSON of a protocol known by its DBC alone."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import can
import pytest
from monitor.machine import MACHINE, frame

import typedcan
from typedcan.__main__ import main

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def bus(channel: str) -> Iterator[list[str]]:
    """The options of a virtual bus on which the motor sends, and a stranger."""
    with can.Bus(channel, "virtual", ignore_config=True) as sender:
        sender.send_periodic(frame("Motor_Status", Speed=1200, Heat=2), 0.1)
        sender.send_periodic(frame("Motor_Description_Of_Its_Maker", Serial=7), 0.1)
        sender.send_periodic(can.Message(arbitration_id=0x101), 0.1)
        sender.send_periodic(can.Message(arbitration_id=0x300, is_extended_id=False), 0.1)
        yield ["-i", "virtual", "-c", channel]
        sender.stop_all_periodic_tasks()


def test_lines_tell_what_happens_and_sum_up(bus: list[str], capsys: Capture) -> None:
    options = ["--seconds", "0.5", "--interval", "0.2", "--plain"]
    assert main(["--dbc", str(MACHINE), "monitor", *bus, *options]) == 0
    out, errors = capsys.readouterr()
    texts = [line.strip().split("  ", 1)[1] for line in out.splitlines()]
    assert "Motor_Status: never seen -> alive" in texts
    assert "Motor_Description_Of_Its_Maker: never seen -> alive" in texts
    assert "Motor_Status.heat: alarm: Too hot" in texts
    (summary, *_) = (text for text in texts if re.match(r"\d+ frames, ", text))
    # No bit rate is known, so there is no load; and there is no glance.
    words = r"\d+ frames, \d+/s, 2 alive, 2 foreign identifiers, 1 alarms"
    assert re.fullmatch(words, summary)
    assert errors.startswith("typedcan: monitoring ")


def test_json_tells_the_widths_of_identifiers(bus: list[str], capsys: Capture) -> None:
    options = ["--json", "--seconds", "0.4", "--interval", "0.3", "-b", "250000"]
    assert main(["monitor", "--dbc", str(MACHINE), *bus, *options]) == 0
    told = json.loads(capsys.readouterr().out.splitlines()[-1])
    assert {"totals", "messages", "alarms", "transfers", "foreign"} < set(told)
    assert not {"pack", "cells"} & set(told)
    shown = {each["name"]: each for each in told["messages"]}
    short, long = shown["Motor_Status"], shown["Motor_Description_Of_Its_Maker"]
    assert (short["frame_id"], short["is_extended"]) == (0x100, False)
    assert (long["frame_id"], long["is_extended"]) == (0x100, True)
    assert short["last"]["signals"] == {"Speed": 1200, "Heat": {"value": 2, "label": "Too hot"}}
    assert long["last"]["signals"] == {"Serial": 7}
    assert shown["Key_Pressed"]["last"] is None  # 0x101 came with 29 bits
    assert [(each["frame_id"], each["is_extended"]) for each in told["foreign"]] == [
        (0x101, True),
        (0x300, False),
    ]
    assert told["alarms"][0]["text"] == "Too hot"
    assert 0 < told["totals"]["load"] < 1


def test_a_filter_finds_an_identifier_in_its_width(bus: list[str], capsys: Capture) -> None:
    options = ["--json", "--seconds", "0.2", "--interval", "0.1", "--filter", "0x00000100"]
    assert main(["monitor", "--dbc", str(MACHINE), *bus, *options]) == 0
    told = json.loads(capsys.readouterr().out.splitlines()[-1])
    assert [each["name"] for each in told["messages"]] == ["Motor_Description_Of_Its_Maker"]


def test_the_monitor_needs_neither_this_standard_nor_textual_before_there_is_a_view() -> None:
    program = (
        "import sys; sys.modules['swapcan'] = None\n"
        "from typedcan.__main__ import main; status = main(sys.argv[1:])\n"
        "print(sorted({'textual', 'rich', 'pyarrow', 'numpy'} & {*sys.modules}), status)"
    )
    source = str(Path(typedcan.__file__).parents[1])
    options = ["-i", "virtual", "-c", "0", "--plain", "--seconds", "0.1"]
    for arguments in (["monitor", "--help"], ["--dbc", str(MACHINE), "monitor", *options]):
        done = subprocess.run(
            [sys.executable, "-c", program, *arguments],
            env={**os.environ, "PYTHONPATH": source},
            capture_output=True,
            encoding="utf-8",
            timeout=60,
            check=False,
        )
        assert done.stdout.splitlines()[-1] == "[] 0", done.stderr
