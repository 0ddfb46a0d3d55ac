"""The lines of the monitor, to the letter: a session on a clock set by hand that began at 5 s."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import can
import pytest
from monitor.machine import CODEC, frame
from monitor.test_overview import SECOND, serial

from dbcspec.config import find_config
from dbcspec.project import load
from typedcan.commands.monitor_lines import MonitorLines, _rounded
from typedcan.databases.dbc import read_database
from typedcan.dynamic import typed_protocol
from typedcan.monitor.session import Session
from typedcan.monitor.watch import Watch
from typedcan.node.clock import SimulatedClock
from typedcan.node.events import BusBack, BusLost
from typedcan.wire.codec import Codec

Capture = pytest.CaptureFixture[str]


class Printed:
    """A session of the machine whose lines are printed."""

    def __init__(
        self, capsys: Capture, *, as_json: bool = False, name_filter: str = "", codec: Codec = CODEC
    ) -> None:
        self._capsys = capsys
        self._clock = SimulatedClock(5.0)
        self.session = Session(Watch(5.0, codec), self._clock)
        self.lines = MonitorLines(self.session, as_json=as_json, name_filter=name_filter)

    def hear(self, at: float, *frames: can.Message) -> None:
        """Let the session hear frames so many seconds after it began."""
        self._clock.advance_to(5.0 + at)
        self.session.check()
        for each in frames:
            each.timestamp = 5.0 + at
            self.session.take(each)

    def out(self) -> list[str]:
        """The lines since the last call."""
        return self._capsys.readouterr().out.splitlines()


def test_what_happens_is_told_with_the_seconds_since_the_start(capsys: Capture) -> None:
    printed = Printed(capsys)
    printed.hear(0.25, frame("Motor_Status", Heat=2))
    printed.lines.events()
    assert printed.out() == [
        "     0.250  Lamp: not seen",
        "     0.250  Motor_Status: never seen -> alive",
        "     0.250  Motor_Status.heat: alarm: Too hot",
    ]
    printed.hear(0.5, frame("Motor_Status", Heat=0))
    printed.lines.events()
    assert printed.out() == [
        "     0.500  Motor_Status: alive -> late after 0.250 s of silence",
        "     0.500  Motor_Status: late -> alive after 0.250 s of silence",
        "     0.500  Motor_Status.heat: no longer alarm: Normal",
    ]
    printed.lines.events()
    assert printed.out() == []


def test_the_line_that_sums_up_counts_what_there_is(capsys: Capture) -> None:
    printed = Printed(capsys)
    printed.hear(0.0, frame("Key_Pressed"))
    printed.lines.summary()
    assert printed.out() == ["     0.000  1 frames, 0/s"]
    printed.hear(
        0.75,
        frame("Motor_Status", Heat=1),
        frame("Lamp"),
        can.Message(arbitration_id=0x300),
        can.Message(is_error_frame=True),
        can.Message(arbitration_id=0x100, is_extended_id=False, data=bytes(3)),
    )
    printed.hear(0.85)
    printed.session.tell_bus(BusLost("adapter is gone", 5.85))
    printed.hear(1.0)
    printed.lines.summary()
    (line,) = printed.out()
    assert line == (
        "     1.000  6 frames, 6/s, 1 late, 1 lost, 1 faults, 1 foreign identifiers,"
        " 1 error frames, 1 alarms, bus lost: adapter is gone"
    )
    printed.session.tell_bus(BusBack(6.0))
    printed.lines.summary()
    assert printed.out()[-1].endswith("1 error frames, 1 alarms")


def test_a_filter_leaves_out_what_is_told_of_others(capsys: Capture) -> None:
    printed = Printed(capsys, name_filter="motor_st")
    short = can.Message(arbitration_id=0x200, is_extended_id=False, data=bytes(3))
    own = can.Message(arbitration_id=0x100, is_extended_id=False, data=bytes(3))
    printed.hear(0.0, frame("Lamp"), frame("Motor_Status", Heat=1), short, own)
    printed.lines.events()
    assert printed.out() == [
        "     0.000  Motor_Status: never seen -> alive",
        "     0.000  Motor_Status.heat: alarm: Warm",
        "     0.000  Motor_Status: 3 bytes instead of 2",
    ]
    printed.lines.summary()
    assert "1 alive" in printed.out()[0]


def test_a_filter_finds_words_of_what_happens_too(capsys: Capture) -> None:
    printed = Printed(capsys, name_filter="INSTEAD OF")
    short = can.Message(arbitration_id=0x200, is_extended_id=False, data=bytes(3))
    printed.hear(0.0, frame("Motor_Status"), short)
    printed.lines.events()
    assert printed.out() == ["     0.000  Lamp: 3 bytes instead of 1"]


def test_a_fault_is_told_once_of_each_message_until_it_is_summed_up(capsys: Capture) -> None:
    def short(frame_id: int) -> can.Message:
        return can.Message(arbitration_id=frame_id, is_extended_id=False, data=bytes(3))

    printed = Printed(capsys)
    printed.hear(0.0, short(0x200), short(0x200), short(0x100))
    printed.lines.events()
    lines = ["     0.000  Lamp: 3 bytes instead of 1"]
    assert printed.out() == [*lines, "     0.000  Motor_Status: 3 bytes instead of 2"]
    printed.hear(0.0, short(0x200))
    printed.lines.events()
    assert printed.out() == []
    printed.lines.summary()
    printed.hear(0.0, short(0x200))
    printed.lines.events()
    assert printed.out()[1:] == lines


def test_that_a_signal_is_invalid_is_not_told(capsys: Capture) -> None:
    printed = Printed(capsys)
    printed.hear(0.0, frame("Motor_Status", Heat=3), frame("Motor_Status", Heat=0))
    printed.lines.events()
    assert printed.out() == ["     0.000  Motor_Status: never seen -> alive"]


def test_a_text_over_several_frames_is_told_once_it_is_complete(capsys: Capture) -> None:
    printed = Printed(capsys, codec=Codec(typed_protocol(load(find_config(SECOND)).protocol)))
    printed.hear(0.5, *serial(b"A7K2", 0.0), *serial(b"A7K2", 0.0))
    printed.lines.events()
    assert "     0.500  Serial number: A7K2" in printed.out()


def test_at_the_end_it_is_summed_up_where_frames_came_since(capsys: Capture) -> None:
    printed = Printed(capsys)
    printed.lines.end()  # nothing was told yet
    assert printed.out() == ["     0.000  0 frames, 0/s"]
    printed.lines.end()
    assert printed.out() == []
    printed.hear(0.0, frame("Key_Pressed"))
    printed.lines.end()
    assert printed.out() == [
        "     0.000  Key_Pressed: never seen -> alive",
        "     0.000  1 frames, 0/s",
    ]


def test_json_has_objects_alone_and_times_since_the_start(capsys: Capture, tmp_path: Path) -> None:
    printed = Printed(capsys, as_json=True, name_filter="motor_")
    printed.session.record(tmp_path / "drive.log")
    printed.hear(0.3, frame("Motor_Status", Heat=1), frame("Lamp"))
    printed.session.tell_bus(BusLost("adapter is gone", 5.4))
    printed.hear(0.5)
    printed.lines.events()
    assert printed.out() == []
    printed.lines.summary()
    printed.session.stop_recording()
    (line,) = printed.out()
    told: dict[str, Any] = json.loads(line)
    assert list(told) == [
        *("time", "bus_lost", "recording"),
        *("totals", "messages", "alarms", "transfers", "foreign"),
    ]
    assert (told["time"], told["bus_lost"]) == (0.5, "adapter is gone")
    assert told["recording"] == {"file": str(tmp_path / "drive.log"), "frames": 2}
    assert [each["name"] for each in told["messages"]] == [
        "Motor_Status",
        "Motor_Description_Of_Its_Maker",
    ]
    first, second = told["messages"]
    assert first["last"]["signals"]["Heat"] == {"value": 1, "label": "Warm"}
    assert (first["age"], second["last"]) == (0.2, None)


def test_what_a_message_said_last_keeps_its_digits(capsys: Capture, tmp_path: Path) -> None:
    path = tmp_path / "dose.dbc"
    path.write_text(
        'VERSION ""\n\nBS_:\n\nBU_: Gate\n\nBO_ 258 Dose: 4 Gate\n'
        ' SG_ Small : 0|32@1+ (1E-10,0) [0|0] "g" Gate\n'
    )
    codec = Codec(typed_protocol(read_database(path)))
    printed = Printed(capsys, as_json=True, codec=codec)
    printed.hear(0.3, can.Message(arbitration_id=258, is_extended_id=False, data=b"\xd0\0\0\0"))
    printed.lines.summary()
    (line,) = printed.out()
    assert json.loads(line)["messages"][0]["last"]["signals"] == {"Small": 2.08e-8}


def test_numbers_have_microseconds_and_what_json_has_not_is_null() -> None:
    value = {"a": 1.00000049, "b": [0.1234567, {"c": math.inf}], "d": (math.nan, 7, True, "x")}
    assert _rounded(value) == {
        "a": 1.0,
        "b": [0.123457, {"c": None}],
        "d": [None, 7, True, "x"],
    }
