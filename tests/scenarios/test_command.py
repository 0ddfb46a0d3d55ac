"""`swapcan conform` on a bus, in real time: heard, driven, interrupted, and gone."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import can
import pytest
from can.interfaces.virtual import VirtualBus
from commands.running import as_arguments, bus_options, started
from scenarios.lines import values

from swapcan import cli
from swapcan.messages import B2V_ST1, V2B_CMD, BmsState, HvCommand
from swapcan.nodes.bmu import Bmu
from swapcan.scenarios import stage
from typedcan.shell.process_signals import Interrupts
from typedcan.simulate.world import World

NO_INTERRUPTS = pytest.mark.skipif(
    sys.platform == "win32", reason="Windows has no SIGINT for one process"
)


@pytest.fixture
def pack(near: can.BusABC) -> Iterator[Bmu]:
    """A pack that lives on the channel, in a thread of its own."""
    bmu = Bmu(near)
    with World(bmu):
        yield bmu


@pytest.fixture(autouse=True)
def scratch(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where temporary files of this process go."""
    folder = tmp_path / "scratch"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder


def run(channel: str, *arguments: object) -> int:
    """The exit status of the command on a virtual channel."""
    return cli.run(["conform", "-i", "virtual", "-c", channel, *map(str, arguments)])


@pytest.mark.usefixtures("pack")
def test_a_bus_is_recorded_for_a_while_and_the_record_judged(
    channel: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    record = tmp_path / "bench.blf"
    options = ("--judge", "BMU", "--only", "checksum", "--json")
    assert run(channel, "--duration", "700ms", *options, "--record", record) == 0
    (log,) = json.loads(capsys.readouterr().out)["logs"]
    assert log["log"] == str(record)
    assert log["seen"] == ["BMU"]
    with can.LogReader(record) as reader:
        frames = list(reader)
    assert sum(log["frames"].values()) == len(frames) > 30
    assert 0.3 < frames[-1].timestamp - frames[0].timestamp < 0.9


@pytest.mark.usefixtures("pack")
def test_a_record_that_is_not_kept_is_named_like_the_bus_and_gone_afterwards(
    channel: str, scratch: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(channel, "--duration", "1s", "--only", "checksum", "--json") == 0
    (log,) = json.loads(capsys.readouterr().out)["logs"]
    assert log["log"] == f"virtual {channel}"
    assert [each["channel"] for each in log["load"]] == [channel]
    assert list(scratch.iterdir()) == []


def test_a_silent_bus_could_not_be_judged(channel: str) -> None:
    assert run(channel, "--duration", "0.2") == 2


def test_a_record_never_replaces_a_file(
    channel: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    record = tmp_path / "bench.log"
    record.write_text("mine", "ascii")
    assert run(channel, "--duration", "0.2", "--record", record) == 2
    assert "is there already, choose another name" in capsys.readouterr().err
    assert record.read_text("ascii") == "mine"
    assert run(channel, "--record", tmp_path / "a", "--csv", tmp_path / "a") == 2
    assert "is the log" in capsys.readouterr().err


def test_a_bus_that_breaks_is_one_line_and_what_was_recorded_is_kept(
    channel: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    class Breaking(VirtualBus):
        left = 3

        def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
            self.left -= 1
            if self.left < 0:
                raise can.CanOperationError("adapter is gone")
            return can.Message(arbitration_id=0x123, timestamp=1000.0 - self.left), False

    monkeypatch.setattr(can, "Bus", Breaking)
    record = tmp_path / "bench.log"
    assert run(channel, "--record", record) == 2
    assert capsys.readouterr().err.splitlines()[1:] == ["swapcan: adapter is gone"]
    assert record.read_text("ascii").count("123#") == 3


def test_without_the_yes_everything_is_announced_and_no_bus_is_opened(
    channel: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def refuse(**_: Any) -> can.BusABC:
        raise AssertionError("a bus was opened")

    monkeypatch.setattr(can, "Bus", refuse)
    assert run(channel, "--active", "hv-on-off,charge") == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert "V2B_CMD 0x1802F3D0 every 50 ms" in said.err
    assert "HV_OnOff = HV On" in said.err
    assert "THE PACK MAY CLOSE ITS CONTACTORS" in said.err
    assert "THE PACK MAY CLOSE ITS CHARGING CONTACTORS" in said.err
    assert said.err.endswith("swapcan: nothing was sent; --yes-drive-the-bus sends it\n")


@pytest.mark.usefixtures("pack")
def test_a_pack_is_driven_in_real_time_and_its_answers_are_judged(
    channel: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(stage, "LOOK_OUT", 0.3)
    record = tmp_path / "bench.log"
    options = ("--only", "answer-in-time,checksum", "--json", "--record", record)
    assert run(channel, "--active", "requests", "--yes-drive-the-bus", *options) == 0
    said = capsys.readouterr()
    announced, _, played = said.err.partition("swapcan: playing requests on ")
    assert "V2B_RQData: RQSysCode = Request SysCode Data" in announced
    assert "requests: the pack has reported that it is off" in played
    (log,) = json.loads(said.out)["logs"]
    assert (log["nodes"], log["seen"]) == (["BMU"], ["BMU", "VCU"])
    passed = {rule["id"]: rule["examined"] for rule in log["rules"]}
    assert passed["answer-in-time"] == 2  # pack code and basic data
    assert record.exists()


def test_a_pack_that_is_driven_by_somebody_else_is_left_alone(
    channel: str, far: can.BusABC, capsys: pytest.CaptureFixture[str]
) -> None:
    heard = Heard(far)
    task = far.send_periodic(
        can.Message(arbitration_id=V2B_CMD.FRAME_ID, is_extended_id=True, data=bytes(8)), 0.05
    )
    try:
        assert run(channel, "--active", "requests", "--yes-drive-the-bus") == 2
    finally:
        task.stop()
    assert "another VCU is on the bus: V2B_CMD (0x1802F3D0)" in capsys.readouterr().err
    assert heard.frames() == []


class Heard:
    """What others send on a bus."""

    def __init__(self, bus: can.BusABC) -> None:
        self._bus = bus

    def frames(self) -> list[can.Message]:
        """All that came until now."""
        found = []
        while frame := self._bus.recv(0):
            found.append(frame)
        return found


@NO_INTERRUPTS
def test_ctrl_c_ends_the_listening_early_and_what_is_there_is_judged() -> None:
    with started("-m", "swapcan", "conform", "-i", "virtual", "--duration", "5m") as process:
        assert process.stderr
        assert "listening on virtual for 300 s, Ctrl-C ends it early" in process.stderr.readline()
        process.send_signal(signal.SIGINT)
        out, errors = process.communicate(timeout=20)
    assert process.returncode == 2  # nothing was heard
    assert "Traceback" not in errors
    assert "could not be judged" in out.lower() or "not judged" in out.lower()


@NO_INTERRUPTS
def test_ctrl_c_typed_twice_while_a_pack_is_live_still_switches_it_off() -> None:
    options = bus_options("udp_multicast")
    command = ("-m", "swapcan", "conform", "--active", "hv-on-off", "--yes-drive-the-bus")
    with (
        can.Bus(ignore_config=True, **options) as bus,
        can.Bus(ignore_config=True, **options) as listener,
    ):
        pack = Bmu(bus)
        with World(pack), started(*command, *as_arguments(options)) as process:
            interrupt_when_closed(listener, process)
            _, errors = process.communicate(timeout=20)
        commands = [
            values(frame)["V2B_CMD_HV_OnOff"]
            for frame in Heard(listener).frames()
            if frame.arbitration_id == V2B_CMD.FRAME_ID
        ]
    assert process.returncode == 130
    assert "Traceback" not in errors
    assert "hv-on-off: the pack has reported that it is off" in errors
    assert pack.state.state is BmsState.HV_OPEN
    assert commands[-7:] == [HvCommand.HV_OFF] * 7


def interrupt_when_closed(bus: can.BusABC, process: subprocess.Popen[str]) -> None:
    """Type Ctrl-C once the pack has high voltage, and again once it is told to switch off."""
    for kind, signal_name, value in (
        (B2V_ST1, "B2V_ST1_BMS", BmsState.HV_CLOSED),
        (V2B_CMD, "V2B_CMD_HV_OnOff", HvCommand.HV_OFF),
    ):
        while True:
            frame = bus.recv(10.0)
            assert frame, "nobody talks any more"
            if frame.arbitration_id == kind.FRAME_ID and values(frame)[signal_name] == value:
                break
        process.send_signal(signal.SIGINT)


@NO_INTERRUPTS
def test_signals_are_counted_and_what_was_there_before_comes_back() -> None:
    before = signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM)
    interrupts = Interrupts()
    with interrupts:
        signal.raise_signal(signal.SIGINT)
        interrupts.go_on()  # the first ends what is going on, not the program
        signal.raise_signal(signal.SIGINT)
    assert interrupts.is_over
    assert (signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM)) == before
    with pytest.raises(KeyboardInterrupt):
        interrupts.go_on()
    with Interrupts() as ended:
        signal.raise_signal(signal.SIGTERM)
    assert ended.is_over
    with pytest.raises(SystemExit, match="143"):
        ended.go_on()
