"""`swapcan monitor` in a real terminal, on a bus where another process sends."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from uuid import uuid4

import can
import pytest

pytest.importorskip("textual", reason="the view needs textual")
TMUX = shutil.which("tmux")
if TMUX is None:
    pytest.skip("tmux is not installed", allow_module_level=True)

GROUP = "239.74.163.4"

_SENDER = """
import sys, time, can
from swapcan import Link
from swapcan.messages import B2V_ST2
with can.Bus(sys.argv[1], "udp_multicast", ignore_config=True, port=int(sys.argv[2])) as bus:
    link = Link(bus)
    while True:
        link.send(B2V_ST2(soc=76.4, current=80.0))
        time.sleep(0.1)
"""


@pytest.fixture
def port() -> int:
    """A free port, of a group that works here."""
    pytest.importorskip("msgpack", reason="python-can's udp_multicast needs msgpack")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("", 0))
        number = int(probe.getsockname()[1])
    try:
        bus = can.Bus(GROUP, "udp_multicast", ignore_config=True, port=number)
    except can.CanError as error:
        pytest.skip(f"no multicast here: {error}")
    with bus:
        bus.send(can.Message(arbitration_id=0x1))
        if bus.recv(1.0) is None:
            pytest.skip("no multicast here: a datagram to the group does not come back")
    return number


@pytest.fixture
def sender(port: int, environment: dict[str, str]) -> Iterator[None]:
    """A process that sends the state of a pack."""
    command = [sys.executable, "-c", _SENDER, GROUP, str(port)]
    with subprocess.Popen(command, env=environment) as process:
        yield
        process.kill()


class Terminal:
    """A terminal of tmux with the monitor in it; its process id is written to a file."""

    def __init__(self, port: int, folder: Path, environment: dict[str, str]) -> None:
        self._socket = f"swapcan-{uuid4()}"
        self._pid = folder / "pid"
        words = [sys.executable, "-m", "swapcan", "monitor", "-i", "udp_multicast", "-c", GROUP]
        words += ["--bus-kwargs", f"port={port}", "--record", str(folder / "drive.blf")]
        shell = (
            f"sh -c 'echo $$ > {self._pid}; exec \"$@\"' sh {shlex.join(words)};"
            ' echo "status $?"; stty -a; sleep 60'
        )
        self._environment = environment
        self._run("-f", os.devnull, "new-session", "-d", "-x", "100", "-y", "30", shell)

    def _run(self, *words: str) -> str:
        return subprocess.run(
            [TMUX or "tmux", "-L", self._socket, *words],
            env=self._environment,
            capture_output=True,
            encoding="utf-8",
            timeout=10,
            check=True,
        ).stdout

    def press(self, *keys: str) -> None:
        """Type keys, as tmux names them."""
        self._run("send-keys", *keys)

    def wait_for(self, is_so: Callable[[list[str]], bool]) -> list[str]:
        """The lines of the screen, once they are as expected."""
        deadline = time.monotonic() + 20
        while not is_so(lines := self._run("capture-pane", "-p").splitlines()):
            assert time.monotonic() < deadline, "\n".join(lines)
            time.sleep(0.05)
        return lines

    @property
    def pid(self) -> int:
        """The process of the monitor."""
        return int(self._pid.read_text(encoding="ascii"))

    def codes(self) -> set[int]:
        """The numbers of all escape codes for looks on the screen."""
        found = re.findall(r"\x1b\[([\d;]*)m", self._run("capture-pane", "-p", "-e"))
        return {int(code or 0) for codes in found for code in codes.split(";")}

    def state(self) -> str:
        """Whether the other screen is on, the cursor seen, the mouse taken."""
        return self._run("display", "-p", "#{alternate_on} #{cursor_flag} #{mouse_any_flag}")

    def close(self) -> None:
        """End the terminal with all that is in it."""
        self._run("kill-server")


@pytest.fixture
def terminal(port: int, tmp_path: Path, environment: dict[str, str]) -> Iterator[Terminal]:
    opened = Terminal(port, tmp_path, environment | {"LC_ALL": "C.UTF-8"})
    yield opened
    with suppress(subprocess.CalledProcessError):  # it may be closed already
        opened.close()


def assert_left_in_order(terminal: Terminal, status: int) -> None:
    """The monitor has ended with that status, and left the terminal as it was."""
    lines = terminal.wait_for(lambda lines: any("iexten" in line for line in lines))
    assert f"status {status}" in lines
    words = " ".join(lines).replace(";", " ").split()
    assert {"icanon", "echo", "isig"} <= set(words)
    assert terminal.state().split() == ["0", "1", "0"]
    assert not any("Traceback" in line for line in lines)


@pytest.mark.usefixtures("sender")
def test_the_view_shows_a_bus_obeys_keys_and_leaves_the_terminal_as_it_was(
    terminal: Terminal,
) -> None:
    terminal.wait_for(lambda lines: any(_is_alive(line, "B2V_ST2") for line in lines))
    terminal.press("/", "S", "T", "2", "Enter")
    # The screen is drawn piece by piece: each thing that is to be there is waited for.
    terminal.wait_for(lambda lines: "filter ST2" in lines[1])
    terminal.wait_for(lambda lines: not any(line.startswith("V2B_CMD") for line in lines))
    terminal.press("Enter")
    terminal.wait_for(lambda lines: lines[2].startswith("B2V_ST2  0x1882D0F3"))
    terminal.wait_for(lambda lines: any(_shows_soc(line) for line in lines))
    terminal.press("Space")
    terminal.wait_for(lambda lines: "PAUSED" in lines[1])
    terminal.press("3")
    terminal.wait_for(lambda lines: any(line.split()[:2] == ["SOC", "76.4"] for line in lines))
    terminal.press("q")
    assert_left_in_order(terminal, 0)


def test_ctrl_c_leaves_the_terminal_as_it_was(terminal: Terminal) -> None:
    terminal.wait_for(lambda lines: any(line.startswith("V2B_CMD") for line in lines))
    terminal.press("C-c")
    assert_left_in_order(terminal, 130)


def test_a_monitor_that_is_terminated_leaves_the_terminal_as_it_was(terminal: Terminal) -> None:
    terminal.wait_for(lambda lines: any(line.startswith("V2B_CMD") for line in lines))
    os.kill(terminal.pid, signal.SIGTERM)
    assert_left_in_order(terminal, 143)


@pytest.mark.usefixtures("sender")
def test_a_terminal_that_goes_away_ends_the_monitor_and_closes_its_recording(
    terminal: Terminal, tmp_path: Path
) -> None:
    terminal.wait_for(lambda lines: any(_is_alive(line, "B2V_ST2") for line in lines))
    pid = terminal.pid
    terminal.close()
    deadline = time.monotonic() + 10
    while _runs(pid):
        assert time.monotonic() < deadline
        time.sleep(0.02)
    with can.BLFReader(tmp_path / "drive.blf") as log:
        assert log.file_size == (tmp_path / "drive.blf").stat().st_size
        assert {each.arbitration_id for each in log} >= {0x1882D0F3}


def test_with_no_color_the_terminal_gets_none(
    port: int, tmp_path: Path, environment: dict[str, str]
) -> None:
    terminal = Terminal(port, tmp_path, environment | {"LC_ALL": "C.UTF-8", "NO_COLOR": "1"})
    try:
        terminal.wait_for(lambda lines: any(line.startswith("V2B_CMD") for line in lines))
        codes = terminal.codes()
    finally:
        terminal.close()
    assert codes
    assert codes <= {0, 1, 2, 4, 7, 39, 49}  # bold, dim, underlined, reverse, default colours


def _runs(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def _is_alive(line: str, name: str) -> bool:
    return line.startswith(name) and "alive" in line


def _shows_soc(line: str) -> bool:
    return line.split()[:3] == ["B2V_ST2_SOC", "76.4", "%"]
