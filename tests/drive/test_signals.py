"""Signals to processes that drive a pack whose contactors are closed: they open first."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

import can
import pytest
from commands.running import as_arguments, bus_options, environment, started
from drive.forked import parent
from drive.quick_pack import ENOUGH, QuickPack, living

from swapcan.messages import HvCommand

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signals")

NAMES = ("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT", "SIGUSR1", "SIGUSR2")
YES = "--yes-drive-the-bus"
COMMANDS = {
    "conform": ("conform", "--active", "hv-on-off", YES),
    "simulate": ("simulate", "VCU", "--plan", "hv_on@200ms", YES),
}


@contextmanager
def packs(count: int) -> Iterator[list[tuple[QuickPack, list[str]]]]:
    """Packs, each on a network of its own, with the options that name it."""
    with ExitStack() as stack:
        found = []
        for _ in range(count):
            options = bus_options("udp_multicast")
            bus = stack.enter_context(can.Bus(ignore_config=True, **options))
            found.append((QuickPack(bus), as_arguments(options)))
        stack.enter_context(living(*(pack for pack, _ in found)))
        yield found


@pytest.mark.parametrize("name", COMMANDS)
def test_each_signal_that_ends_a_process_switches_off_first(name: str, tmp_path: Path) -> None:
    command = COMMANDS[name]
    with packs(len(NAMES)) as found, parent() as forking:
        children = forking.fork(tmp_path, [(*command, *options) for _, options in found])
        for (pack, _), child, signal_name in zip(found, children, NAMES, strict=True):
            pack.wait_for(lambda pack=pack: pack.is_closed)  # type: ignore[misc]
            os.kill(child.pid, getattr(signal, signal_name))
        forking.wait()
        for (pack, _), child, signal_name in zip(found, children, NAMES, strict=True):
            assert not pack.is_closed, signal_name
            assert len(pack.since_on) >= 3, signal_name
            assert set(pack.since_on) == {HvCommand.HV_OFF}, signal_name
            assert "Traceback" not in child.errors
            assert "TAKE IT FOR LIVE" not in child.errors
            if name == "conform":
                assert "hv-on-off: the pack has reported that it is off" in child.errors
            if name == "conform" and signal_name == "SIGINT":  # is judged all the same
                assert "it was ended early" in child.errors
                assert child.status in (1, 2)
            else:
                assert child.status == 128 + getattr(signal, signal_name)


@contextmanager
def driving(name: str, options: list[str]) -> Iterator[subprocess.Popen[str]]:
    """A process of its own group, which a shell would let stop."""
    arguments = ("-m", "drive.grouped", *COMMANDS[name], *options)
    with started(*arguments) as process:
        yield process


@pytest.mark.parametrize("name", COMMANDS)
def test_ctrl_z_switches_off_before_it_stops_and_nothing_is_driven_after_that(name: str) -> None:
    with packs(1) as [(pack, options)], driving(name, options) as process:
        pack.wait_for(lambda: pack.is_closed)
        os.kill(process.pid, signal.SIGTSTP)
        stopped = os.waitid(os.P_PID, process.pid, os.WSTOPPED | os.WEXITED | os.WNOWAIT)
        assert stopped
        assert stopped.si_code == os.CLD_STOPPED
        assert not pack.is_closed
        assert len(pack.since_on) >= 3
        count = len(pack.commands)
        os.kill(process.pid, signal.SIGCONT)
        _, errors = process.communicate(timeout=ENOUGH)
        assert HvCommand.HV_ON not in pack.commands[count:]
        assert process.returncode in ((1, 2) if name == "conform" else (128 + signal.SIGTSTP,))
        assert "Traceback" not in errors


def test_who_was_stopped_by_force_does_not_drive_on() -> None:
    with packs(1) as [(pack, options)], driving("simulate", options) as process:
        pack.wait_for(lambda: pack.is_closed)
        os.kill(process.pid, signal.SIGSTOP)  # cannot be caught
        os.waitid(os.P_PID, process.pid, os.WSTOPPED | os.WNOWAIT)
        with pytest.raises(subprocess.TimeoutExpired):
            process.wait(2.5)
        count = len(pack.commands)
        os.kill(process.pid, signal.SIGCONT)
        _, errors = process.communicate(timeout=ENOUGH)
        pack.wait_for(lambda: not pack.is_closed)
        assert set(pack.commands[count:]) == {HvCommand.HV_OFF}
        assert process.returncode == 2
        assert "the program stood still for more than 2 s: what acts was ended" in errors


def test_a_terminal_that_is_closed_leaves_the_pack_open() -> None:
    with packs(1) as [(pack, options)]:
        near, far = os.openpty()
        arguments = ("-m", "drive.grouped", "--terminal", *COMMANDS["conform"], *options)
        with subprocess.Popen(
            [sys.executable, *arguments],
            env=environment(),
            stdin=far,
            stdout=far,
            stderr=far,
            start_new_session=True,
        ) as process:
            os.close(far)
            pack.wait_for(lambda: pack.is_closed)
            os.close(near)
            assert process.wait(ENOUGH) == 128 + signal.SIGHUP
        assert not pack.is_closed
        assert set(pack.since_on) == {HvCommand.HV_OFF}


@pytest.mark.skipif(sys.platform != "linux", reason="fills a pipe by way of /proc")
@pytest.mark.parametrize("typed", [False, True], ids=["is_read_again", "ctrl_c"])
def test_an_output_that_nobody_reads_on_does_not_keep_the_pack_live(*, typed: bool) -> None:
    with packs(1) as [(pack, options)], driving("simulate", options) as process:
        assert process.stdout
        pack.wait_for(lambda: pack.is_closed)
        fill(process.stdout.fileno())
        pack.skips = True  # what it notices it would print
        pack.wait_for(lambda: not pack.is_closed)
        pack.wait_for(lambda: len(pack.since_on) >= 3)
        if typed:
            os.kill(process.pid, signal.SIGINT)
        _, errors = process.communicate(timeout=ENOUGH)
    assert process.returncode == (130 if typed else 2)
    assert set(pack.since_on) == {HvCommand.HV_OFF}
    assert "the program stands still: what acts was ended" in errors
    assert "Traceback" not in errors


def fill(reading: int) -> None:
    """Write into a pipe until it is full, by way of the end that reads."""
    writing = os.open(f"/proc/self/fd/{reading}", os.O_WRONLY | os.O_NONBLOCK)
    with suppress(BlockingIOError):
        while os.write(writing, b"\n"):
            pass
    os.close(writing)
