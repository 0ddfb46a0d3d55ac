"""A program that hangs while high voltage is on, in real time: another thread switches off."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import can
import pytest
from can.interfaces.virtual import VirtualBus
from scenarios.lines import values

from swapcan import cli, encode
from swapcan.messages import V2B_CMD, BmsState, HvCommand
from swapcan.nodes.bmu import Bmu
from swapcan.wire import Codec
from typedcan.drive import driving, watchdog
from typedcan.drive.noting_bus import NotingBus
from typedcan.drive.watchdog import HungError, Watchdog
from typedcan.node.clock import SimulatedClock, SystemClock
from typedcan.shell.recording import Recording
from typedcan.simulate.world import World

ENOUGH = 20.0
"""Seconds after which a test has failed, on a busy machine too."""


def command(hv: HvCommand, counter: int) -> can.Message:
    data = encode(V2B_CMD(hv_on_off=hv, vehicle_speed=0.0), counter=counter)
    return can.Message(arbitration_id=V2B_CMD.FRAME_ID, data=data)


def commands(bus: can.BusABC, wait: float = 0.0) -> Iterator[object]:
    """The commands for high voltage that arrive."""
    while frame := bus.recv(wait):
        if frame.arbitration_id == V2B_CMD.FRAME_ID:
            yield values(frame)["V2B_CMD_HV_OnOff"]


@pytest.fixture(autouse=True)
def _no_thread_is_left() -> Iterator[None]:
    before = set(threading.enumerate())
    yield
    assert {each for each in threading.enumerate() if each.name.startswith("swapcan")} <= before


def test_off_is_sent_again_and_again_where_no_beat_comes_and_on_no_more(
    near: can.BusABC, far: can.BusABC, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(watchdog, "_PATIENCE", 0.3)
    warned = threading.Semaphore(0)
    with NotingBus(near, Codec(), lambda _: None) as bus:
        dog = Watchdog([bus], SystemClock(), warned.release)
        with dog:
            bus.send(command(HvCommand.HV_ON, 0))
            heard = commands(far, ENOUGH)
            assert next(heard) == HvCommand.HV_ON
            assert [next(heard) for _ in range(5)] == [HvCommand.HV_OFF] * 5
            assert warned.acquire(timeout=ENOUGH)
            with pytest.raises(HungError, match=r"what acts was ended$"):
                bus.send(command(HvCommand.HV_ON, 1))
            dog.beat()
            with pytest.raises(HungError):
                dog.check()
        assert not dog.is_late
        assert not warned.acquire(blocking=False)  # once is enough
        assert set(commands(far)) <= {HvCommand.HV_OFF}


@pytest.fixture
def now(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """The time of watchdogs, set by hand."""
    time_of_day = [100.0]
    monkeypatch.setattr(watchdog, "_now", lambda: time_of_day[0])
    return time_of_day


def test_who_gives_signs_of_life_is_left_alone(
    near: can.BusABC, far: can.BusABC, now: list[float]
) -> None:
    with NotingBus(near, Codec(), lambda _: None) as bus, Watchdog([bus], SystemClock()) as dog:
        bus.send(command(HvCommand.HV_ON, 0))
        for _ in range(10):
            now[0] += 1.9
            time.sleep(0.06)  # it looks every 50 ms
            dog.check()
            dog.beat()
        assert list(commands(far)) == [HvCommand.HV_ON]


def test_where_nothing_acts_it_does_nothing(
    near: can.BusABC, far: can.BusABC, now: list[float]
) -> None:
    with NotingBus(near, Codec(), lambda _: None) as bus, Watchdog([bus], SystemClock()) as dog:
        bus.send(command(HvCommand.HV_OFF, 0))
        now[0] += 60.0
        time.sleep(0.1)
        assert dog.is_late
        dog.check()
        dog.beat()
        bus.send(command(HvCommand.HV_ON, 1))
        assert list(commands(far)) == [HvCommand.HV_OFF, HvCommand.HV_ON]


def test_a_machine_that_was_asleep_commands_nothing_that_acts_after_that(
    near: can.BusABC, far: can.BusABC, now: list[float]
) -> None:
    with NotingBus(near, Codec(), lambda _: None) as bus, Watchdog([bus], SystemClock()):
        bus.send(command(HvCommand.HV_ON, 0))
        now[0] += 1.9
        bus.send(command(HvCommand.HV_ON, 1))
        now[0] += 0.2  # neither thread has run in the meantime
        with pytest.raises(HungError):
            bus.send(command(HvCommand.HV_ON, 2))
        heard = list(commands(far))
        assert heard[:2] == [HvCommand.HV_ON] * 2
        assert set(heard[2:]) <= {HvCommand.HV_OFF}


def test_on_a_simulated_clock_there_is_no_thread(near: can.BusABC) -> None:
    before = threading.active_count()
    clock = SimulatedClock()
    with (
        NotingBus(near, Codec(), lambda _: None, clock=clock) as bus,
        Watchdog([bus], clock) as dog,
    ):
        assert threading.active_count() == before
        assert not dog.is_late


@pytest.mark.skipif(not hasattr(time, "CLOCK_BOOTTIME"), reason="there is no such clock here")
def test_the_time_in_which_the_machine_sleeps_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    clocks = {time.CLOCK_BOOTTIME: 42.0}
    monkeypatch.setattr(time, "clock_gettime", clocks.__getitem__)
    assert watchdog._now() == 42.0


class HangingIn:
    """Hangs the main thread once the pack is closed, until the pack is open again."""

    def __init__(self, pack: Bmu) -> None:
        self._pack = pack
        self.hung = 0.0

    def __call__(self) -> None:
        closed = self._pack.state.state is BmsState.HV_CLOSED
        if self.hung or not closed or threading.current_thread() is not threading.main_thread():
            return
        begin = time.monotonic()
        while self._pack.pack.relays.closed and time.monotonic() < begin + ENOUGH:
            time.sleep(0.02)
        self.hung = time.monotonic() - begin


@pytest.fixture
def pack(near: can.BusABC) -> Iterator[Bmu]:
    """A pack that lives on the channel, in a thread of its own."""
    bmu = Bmu(near)
    with World(bmu):
        yield bmu


def before(action: Callable[[], object], method: Callable[..., Any]) -> Callable[..., Any]:
    """A method before which something is done."""

    def with_it(*arguments: Any, **named: Any) -> Any:
        action()
        return method(*arguments, **named)

    return with_it


@pytest.mark.parametrize("place", ["recorder", "recv", "send"])
def test_conform_in_a_recorder_or_a_driver_that_hangs_switches_off_and_ends(
    place: str,
    channel: str,
    pack: Bmu,
    far: can.BusABC,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(driving, "LOOK_OUT", 0.2)
    if place != "recorder":  # once with its real patience
        monkeypatch.setattr(watchdog, "_PATIENCE", 0.7)
    hang = HangingIn(pack)

    class Hanging(VirtualBus):
        pass

    if place == "recorder":
        monkeypatch.setattr(Recording, "write", before(hang, Recording.write))
    elif place == "recv":
        Hanging._recv_internal = before(hang, VirtualBus._recv_internal)  # type: ignore[method-assign]
    else:
        Hanging.send = before(hang, VirtualBus.send)  # type: ignore[method-assign]
    monkeypatch.setattr(can, "Bus", lambda **given: Hanging(given["channel"]))
    options = ("--active", "hv-on-off", "--yes-drive-the-bus")
    record = tmp_path / "bench.log"
    status = cli.run(["conform", "-i", "virtual", "-c", channel, *options, "--record", str(record)])
    assert status == 2
    assert 0.3 < hang.hung < 10.0  # the patience, and what a pack takes to open
    errors = capfd.readouterr().err.splitlines()
    assert "swapcan: hv-on-off: the pack has reported that it is off" in errors
    assert any("the program stands still: what acts was ended" in line for line in errors)
    assert "the program stood still for more than" in errors[-1]
    sent = list(commands(far))
    ons = [number for number, each in enumerate(sent) if each == HvCommand.HV_ON]
    offs = sent[ons[-1] + 1 :]
    assert len(offs) >= 3
    assert set(offs) == {HvCommand.HV_OFF}
    with can.LogReader(record) as reader:
        frames = [each for each in reader if each.arbitration_id == V2B_CMD.FRAME_ID]
    assert [values(each)["V2B_CMD_HV_OnOff"] for each in frames] == sent
