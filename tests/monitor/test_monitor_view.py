"""The view, driven by Textual's pilot: what the keys do."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path

import can
import pytest
from monitor.monitored import Monitored, frame

pytest.importorskip("textual", reason="the view needs textual")

from monitor.screen import rows_of, screen_lines
from textual.pilot import Pilot

from typedcan.monitor.view import MonitorApp
from typedcan.node.events import BusBack, BusLost

Steps = Callable[[Pilot[int]], Awaitable[None]]


def show(
    monitored: Monitored, steps: Steps, size: tuple[int, int] = (100, 30), bus: str = "test bus"
) -> int | None:
    """Show a session, do the steps, and return the exit status if the view was left."""
    app = MonitorApp(monitored.session, bus, record_name="swapcan")

    async def run() -> None:
        async with app.run_test(size=size) as pilot:
            await pilot.pause()
            await steps(pilot)

    asyncio.run(run())
    return app.return_value


def press(*keys: str) -> Steps:
    async def steps(pilot: Pilot[int]) -> None:
        await pilot.press(*keys)

    return steps


async def renewed(pilot: Pilot[int]) -> list[str]:
    """The screen once the next picture is shown."""
    assert isinstance(pilot.app, MonitorApp)
    await pilot.pause()
    pilot.app.renew()
    await pilot.pause()
    return screen_lines(pilot.app)


@pytest.mark.parametrize(("key", "status"), [("q", 0), ("f10", 0), ("ctrl+c", 130)])
def test_the_view_is_left_with_its_exit_status(key: str, status: int, monitored: Monitored) -> None:
    assert show(monitored, press(key)) == status


def test_messages_are_shown_in_the_order_of_the_standard(monitored: Monitored) -> None:
    async def steps(pilot: Pilot[int]) -> None:
        rows = rows_of(await renewed(pilot))
        assert len(rows) == 25
        assert [row.split()[0] for row in rows][:2] == ["V2B_CMD", "B2V_RQ"]
        shown = next(row for row in rows if row.startswith("B2V_ST2"))
        words = "B2V_ST2 0x1882D0F3 BMU alive 1 100.0 ms 0.00 s 0"
        assert shown.split() == words.split()

    monitored.hear(frame("B2V_ST2", 0.0, SOC=102))
    show(monitored, steps)


def test_a_filter_leaves_the_rows_that_match_until_escape(monitored: Monitored) -> None:
    async def steps(pilot: Pilot[int]) -> None:
        await pilot.press("slash", *"tms", "enter")
        lines = await renewed(pilot)
        assert [row.split()[0] for row in rows_of(lines)] == ["BMS_TMS_0", "TMS_BMS_0"]
        assert "filter tms" in lines[1]
        await pilot.press("n")
        assert pilot.app.query_one("#messages-table").has_focus
        await pilot.press("enter")
        assert (await renewed(pilot))[2].startswith("TMS_BMS_0  0x18FFC13A")
        await pilot.press("1", "escape")
        assert len(rows_of(await renewed(pilot))) == 25

    show(monitored, steps)


def test_keys_typed_into_the_filter_do_nothing_else(monitored: Monitored) -> None:
    async def steps(pilot: Pilot[int]) -> None:
        await pilot.press("slash", *"qpscr", "tab")
        lines = await renewed(pilot)
        assert lines[-1].startswith("filter: qpscr")
        assert "PAUSED" not in lines[1]
        await pilot.press("escape")
        lines = await renewed(pilot)
        assert lines[-1].startswith("q quit  / filter")
        assert len(rows_of(lines)) == 25

    assert show(monitored, steps) is None


@pytest.mark.parametrize("key", ["space", "p"])
def test_a_paused_picture_stands_still_while_frames_are_counted(
    key: str, monitored: Monitored
) -> None:
    async def steps(pilot: Pilot[int]) -> None:
        await pilot.press(key)
        monitored.hear(frame("B2V_ST2", 1.0), frame("B2V_ST2", 1.1))
        lines = await renewed(pilot)
        assert "PAUSED, 2 frames since" in lines[1]
        assert all("alive" not in row for row in rows_of(lines))
        await pilot.press(key)
        lines = await renewed(pilot)
        assert "PAUSED" not in lines[1]
        assert any("alive" in row for row in rows_of(lines))

    show(monitored, steps)


def test_rows_are_sorted_by_one_column_after_the_other(monitored: Monitored) -> None:
    async def steps(pilot: Pilot[int]) -> None:
        await pilot.press("s")
        lines = await renewed(pilot)
        names = [row.split()[0] for row in rows_of(lines)]
        assert names == sorted(names)
        assert "sort message" in lines[1]
        await pilot.press("f6", "s", "s", "s")
        lines = await renewed(pilot)
        assert "sort frames" in lines[1]
        assert [row.split()[0] for row in rows_of(lines)][:2] == ["B2V_ST3", "B2V_ST2"]

    monitored.hear(*(frame(f"B2V_ST{n}", 0.0) for n in (3, 2, 3)))
    show(monitored, steps)


def test_a_click_on_a_heading_sorts_and_one_on_a_pane_shows_it(monitored: Monitored) -> None:
    async def steps(pilot: Pilot[int]) -> None:
        await pilot.click("#messages-table", offset=(2, 0))
        assert "sort message" in (await renewed(pilot))[1]
        await pilot.click("#panes", offset=(28, 0))
        assert (await renewed(pilot))[2] == "alarms  none"

    show(monitored, steps)


def test_tab_goes_round_the_panes_and_enter_to_the_signals(monitored: Monitored) -> None:
    async def steps(pilot: Pilot[int]) -> None:
        await pilot.press(*"jjjk", "enter")
        assert (await renewed(pilot))[2].startswith("V2B_VIN  0x18E1F3D0  VCU > BMU  on event")
        await pilot.press("right")
        assert (await renewed(pilot))[2].startswith("V2B_RQData")
        await pilot.press("tab")
        assert (await renewed(pilot))[2] == "alarms  none"
        await pilot.press("tab", "G")
        await pilot.press("enter")
        assert (await renewed(pilot))[2].startswith("BSU_BMS_0")
        await pilot.press("shift+tab", "g", "2")
        assert (await renewed(pilot))[2].startswith("V2B_CMD")

    show(monitored, steps)


def test_signals_are_shown_with_their_marks(monitored: Monitored) -> None:
    async def steps(pilot: Pilot[int]) -> None:
        await pilot.press("slash", *"ST1", "enter", "enter")
        await pilot.press("slash", *"temp", "enter")
        lines = await renewed(pilot)
        shown = next(line for line in lines if line.startswith("B2V_ST1_Flt_OverTemp"))
        assert shown.split("  ")[-1].strip() == "0.00 s"
        assert "2 Level 2-More severe fault" in shown
        assert "! alarm" in shown

    monitored.hear(frame("B2V_ST1", 0.0, Flt_OverTemp=2))
    show(monitored, steps)


@pytest.mark.parametrize("key", ["h", "question_mark", "f1"])
def test_help_is_shown_and_goes_away(key: str, monitored: Monitored) -> None:
    async def steps(pilot: Pilot[int]) -> None:
        await pilot.press(key)
        assert any("g G: top, end" in line for line in screen_lines(pilot.app))
        await pilot.press("q")
        assert len(rows_of(await renewed(pilot))) == 25

    assert show(monitored, steps) is None


def test_clearing_counts_anew(monitored: Monitored) -> None:
    async def steps(pilot: Pilot[int]) -> None:
        await pilot.press("c")
        assert all("alive" not in row for row in rows_of(await renewed(pilot)))

    monitored.hear(frame("B2V_ST2", 0.0))
    show(monitored, steps)


def test_recording_begins_and_ends_with_r(
    monitored: Monitored, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def steps(pilot: Pilot[int]) -> None:
        await pilot.press("r", "enter")
        monitored.hear(frame("B2V_ST2", 0.1))
        assert "REC swapcan-1.blf 1" in (await renewed(pilot))[1]
        await pilot.press("r")
        lines = await renewed(pilot)
        assert "REC" not in lines[1]
        assert lines[-1] == "swapcan-1.blf: recorded 1 frames"

    monkeypatch.chdir(tmp_path)
    show(monitored, steps)
    with can.LogReader(tmp_path / "swapcan-1.blf") as log:
        assert [each.arbitration_id for each in log] == [0x1882D0F3]


def test_a_recording_that_cannot_begin_is_told_and_the_view_goes_on(
    monitored: Monitored, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def steps(pilot: Pilot[int]) -> None:
        await pilot.press("r", "ctrl+u", *"a.xyz", "enter")
        assert (await renewed(pilot))[-1].startswith("a.xyz: python-can writes no .xyz")

    monkeypatch.chdir(tmp_path)
    assert show(monitored, steps) is None


def test_a_lost_bus_is_told_until_it_is_back(monitored: Monitored) -> None:
    async def steps(pilot: Pilot[int]) -> None:
        monitored.session.tell_bus(BusLost("Network is down", 0.0))
        assert (await renewed(pilot))[1].startswith(" bus lost: Network is down ")
        monitored.session.tell_bus(BusBack(1.0))
        assert "bus lost" not in (await renewed(pilot))[1]

    show(monitored, steps)


def test_what_would_steer_the_terminal_is_shown(monitored: Monitored) -> None:
    async def steps(pilot: Pilot[int]) -> None:
        assert isinstance(pilot.app, MonitorApp)
        monitored.session.tell_bus(BusLost("gone\x1b[2J\n\u202e", 0.0))
        pilot.app._prompt.say("a\x07.blf: recorded\n")
        lines = await renewed(pilot)
        assert lines[0].endswith(r"  can\x1b]0;x\x07")
        assert lines[1].startswith(r" bus lost: gone\x1b[2J\n\u202e ")
        assert lines[-1] == r"a\x07.blf: recorded\n"

    show(monitored, steps, bus="can\x1b]0;x\x07")


def test_a_narrow_terminal_has_the_columns_that_fit(monitored: Monitored) -> None:
    async def steps(pilot: Pilot[int]) -> None:
        for pane in "123":
            await pilot.press(pane)
            lines = await renewed(pilot)
            assert len(lines) == 24
            assert max(map(len, lines)) <= 80
        await pilot.press("1")
        heading = (await renewed(pilot))[2].split()
        assert heading == ["message", "from", "state", "frames", "period", "mean", "age", "faults"]
        await pilot.resize_terminal(40, 10)
        assert (await renewed(pilot))[2].split() == ["message", "state", "frames"]

    show(monitored, steps, size=(80, 24))


def test_the_view_ends_when_it_is_time(monitored: Monitored) -> None:
    app = MonitorApp(monitored.session, "test bus", is_over=lambda: True)

    async def run() -> None:
        async with app.run_test() as pilot:
            await pilot.pause(0.3)

    asyncio.run(run())
    assert app.return_value == 0
