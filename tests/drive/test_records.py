"""Records while a pack is driven: they have it all, or the pack is off and a line says why."""

from __future__ import annotations

import itertools
import math
import sys
from pathlib import Path
from typing import Any

import can
import pytest
from can.interfaces.virtual import VirtualBus
from drive.quick_pack import QuickPack, living
from drive.trouble import QUICK
from monitor.test_monitor_recording import full_disk
from scenarios.lines import values

from swapcan import cli
from swapcan.messages import B2V_ST1, HvCommand
from swapcan.scenarios import scenarios
from typedcan.drive import driving

COMMAND = ("conform", "--active", QUICK.name, "--yes-drive-the-bus", "-i", "virtual", "-c")


@pytest.fixture(autouse=True)
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(driving, "LOOK_OUT", 0.2)
    monkeypatch.setattr(scenarios, "SCENARIOS", {QUICK.name: QUICK})


def with_times(second: float) -> type[VirtualBus]:
    """A bus that gives every second frame an impossible time."""

    class Timed(VirtualBus):
        count = 0

        def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
            frame, is_filtered = super()._recv_internal(timeout)
            if frame:
                self.count += 1
                frame.timestamp = second if self.count % 2 else frame.timestamp
            return frame, is_filtered

    return Timed


@pytest.mark.parametrize(
    ("second", "suffix"),
    [(math.inf, ".blf"), (math.nan, ".trc"), (-1.0, ".log")],
)
def test_impossible_times_end_nothing_and_every_frame_is_kept(
    second: float,
    suffix: str,
    channel: str,
    near: can.BusABC,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    bus_class = with_times(second)
    monkeypatch.setattr(can, "Bus", lambda **given: bus_class(given["channel"]))
    record = tmp_path / f"bench{suffix}"
    pack = QuickPack(near)
    with living(pack):
        status = cli.run([*COMMAND, channel, "--record", str(record)])
    assert status in (0, 1)
    assert HvCommand.HV_ON in pack.commands
    assert set(pack.since_on) == {HvCommand.HV_OFF}
    assert "the pack has reported that it is off" in capsys.readouterr().err
    with can.LogReader(record) as reader:
        frames = list(reader)
    counters = [
        values(each)["B2V_ST1_ALIV"] for each in frames if each.arbitration_id == B2V_ST1.FRAME_ID
    ]
    assert len(counters) > 10
    assert {(int(b) - int(a)) % 15 for a, b in itertools.pairwise(counters)} == {1}  # type: ignore[call-overload]
    assert frames[-1].timestamp - frames[0].timestamp < 20.0


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no limit for the size of files")
@pytest.mark.parametrize("suffix", [".log", ".asc"])
def test_a_disk_that_is_full_while_the_pack_is_live_switches_it_off(
    suffix: str,
    channel: str,
    near: can.BusABC,
    far: can.BusABC,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    class Talkative(QuickPack):
        """So that a file grows beyond what is buffered."""

        def turn(self) -> None:
            super().turn()
            for _ in range(50 if self.is_closed else 0):
                far.send(can.Message(arbitration_id=0x123, data=bytes(8)))

    record = tmp_path / f"bench{suffix}"
    pack = Talkative(near)
    with living(pack), full_disk(4096):
        status = cli.run([*COMMAND, channel, "--record", str(record)])
    assert status == 2
    assert HvCommand.HV_ON in pack.commands
    assert set(pack.since_on) == {HvCommand.HV_OFF}
    assert len(pack.since_on) >= 3
    errors = capsys.readouterr().err.splitlines()
    assert f"swapcan: {QUICK.name}: the pack has reported that it is off" in errors
    assert errors[-1].startswith(f"swapcan: {record}: ")


def test_a_pack_that_does_not_switch_off_is_driven_no_further(
    channel: str,
    near: can.BusABC,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(driving, "LEAVING", 1.0)
    again: dict[str, Any] = {"again": QUICK, QUICK.name: QUICK}
    monkeypatch.setattr(scenarios, "SCENARIOS", again)
    pack = QuickPack(near, obeys=False)
    with living(pack):
        status = cli.run(["conform", "--active", f"{QUICK.name},again", *COMMAND[3:], channel])
    assert status in (1, 2)
    errors = capsys.readouterr().err
    assert errors.count("swapcan: playing ") == 1
    assert "TAKE IT FOR LIVE, switch it off by other means" in errors
    assert f"the pack has not reported that it is off; not played: {QUICK.name}" in errors
