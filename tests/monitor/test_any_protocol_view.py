"""The view of a second protocol: identifiers in their widths, alarms in place of a glance."""

from __future__ import annotations

import asyncio
from pathlib import Path

import can
import pytest
from monitor.machine import frame, machine
from monitor.monitored import Monitored

pytest.importorskip("textual", reason="the view needs textual")

from monitor.screen import rows_of, screen_lines

from typedcan.monitor.view import MonitorApp


def screen(monitored: Monitored, *keys: str, width: int = 120) -> list[str]:
    """What is on the screen after some keys."""
    app = MonitorApp(monitored.session, "test bus")

    async def run() -> list[str]:
        async with app.run_test(size=(width, 30)) as pilot:
            await pilot.pause()
            await pilot.press(*keys)
            app.renew()
            await pilot.pause()
            return screen_lines(app)

    return asyncio.run(run())


def test_messages_stand_with_their_whole_names_and_the_widths_of_their_identifiers() -> None:
    monitored = machine()
    monitored.hear(frame("Motor_Status"), frame("Key_Pressed"))
    lines = screen(monitored)
    assert lines[0].split() == ["1", "messages", "2", "signals", "3", "overview", "test", "bus"]
    assert "load" not in lines[1]
    assert [row.split()[:3] for row in rows_of(lines)] == [
        ["Motor_Status", "0x100", "Motor"],
        ["Motor_Description_Of_Its_Maker", "0x00000100", "Motor"],
        ["Key_Pressed", "0x101", "Panel"],
        ["Lamp", "0x200", "Light"],
        ["Pages", "0x201", "Light"],
    ]
    assert "on event" in rows_of(lines)[2]


def test_the_signals_of_a_message_that_nobody_receives_are_shown() -> None:
    monitored = machine()
    monitored.hear(frame("Key_Pressed", Key=7))
    lines = screen(monitored, "j", "j", "enter")
    assert lines[2].startswith("Key_Pressed  0x101  Panel > -  on event")
    assert lines[4].split()[:2] == ["Key", "7"]


def test_messages_can_be_sorted_by_receiver_though_one_has_none() -> None:
    lines = screen(machine(), *"sssssssssssss", width=160)
    assert "sort to" in lines[1]
    assert rows_of(lines)[0].startswith("Key_Pressed")


def test_alarms_are_listed_where_there_is_no_glance() -> None:
    monitored = machine()
    assert screen(monitored, "3")[2:4] == ["alarms  none", ""]
    monitored.hear(frame("Motor_Status", 1.0, Heat=2))
    monitored.clock.advance_to(1.5)
    assert screen(monitored, "3")[2:5] == [
        "alarms  1",
        "! Too hot  How hot the motor is, Motor_Status, since 0.50 s",
        "",
    ]
    assert screen(monitored, "3", width=20)[3] == "! Too hot  How hot …"


def test_the_help_names_the_panes_that_there_are() -> None:
    assert any("messages, signals, overview" in line for line in screen(machine(), "h"))


def test_what_a_terminal_would_obey_in_a_unit_is_shown() -> None:
    monitored = machine()
    monitored.hear(frame("Lamp", Brightness=50))
    lines = screen(monitored, "G", "k", "enter")
    assert r"50 \x1b[2Jlux" in lines[4]


def test_the_name_of_a_recording_is_proposed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    screen(machine(), "r", "enter", "r")
    with can.LogReader(tmp_path / "recording-1.blf") as log:
        assert list(log) == []
