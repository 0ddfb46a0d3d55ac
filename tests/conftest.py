"""What all tests share: the project under test, virtual buses, payloads as in every other run."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from uuid import uuid4

import can
import pytest
from hypothesis import settings
from node.bench import Recorder

from dbcspec.config import find_config
from dbcspec.project import Project, load
from typedcan.model.protocol import Protocol
from typedcan.shell import process_signals

# Many tests run commands as processes of their own: let those keep their bytecode.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# A job in the background ignores some signals, one under nohup ignores others, and so would every
# command that a test sends one of them; what does nothing here is no handler there.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
for _name in (
    "SIGHUP",
    "SIGQUIT",
    "SIGTERM",
    "SIGUSR1",
    "SIGUSR2",
    "SIGTSTP",
    "SIGTTIN",
    "SIGTTOU",
):
    if hasattr(signal, _name) and signal.getsignal(getattr(signal, _name)) is signal.SIG_IGN:
        signal.signal(getattr(signal, _name), lambda *_: None)

settings.register_profile(
    "repeatable", derandomize=True, database=None, deadline=None, max_examples=60
)
settings.load_profile("repeatable")


@pytest.fixture(scope="session")
def root() -> Path:
    """The folder of the checkout."""
    return Path(__file__).parent.parent


@pytest.fixture(scope="session")
def project(root: Path) -> Project:
    """The project's own spec, read, corrected and resolved."""
    return load(find_config(root))


@pytest.fixture(scope="session")
def protocol(project: Project) -> Protocol:
    """The model of the project's own spec."""
    return project.protocol


@pytest.fixture
def channel() -> str:
    """A channel of the virtual interface that nobody else has."""
    return f"test-{uuid4()}"


@pytest.fixture
def open_bus(channel: str) -> Iterator[Callable[..., can.BusABC]]:
    """Opens buses on the channel, and closes them after the test."""
    buses: list[can.BusABC] = []

    def open_one(**options: object) -> can.BusABC:
        bus = can.Bus(channel, "virtual", ignore_config=True, **options)  # type: ignore[arg-type]
        buses.append(bus)
        return bus

    yield open_one
    for bus in buses:
        bus.shutdown()


@pytest.fixture
def near(open_bus: Callable[..., can.BusABC]) -> can.BusABC:
    return open_bus()


@pytest.fixture
def far(open_bus: Callable[..., can.BusABC]) -> can.BusABC:
    """The other end of `near`."""
    return open_bus()


@pytest.fixture
def untouched_signals() -> Iterator[None]:
    """Nobody listens to any, whatever has started this test run; afterwards all is as it was."""
    before = {number: signal.getsignal(number) for number in signal.valid_signals()}
    ours = {number for number, handler in before.items() if handler is not None}
    for number in ours - {signal.SIGPIPE, signal.SIGXFSZ, signal.SIGKILL, signal.SIGSTOP}:
        ctrl_c = number == signal.SIGINT
        signal.signal(number, signal.default_int_handler if ctrl_c else signal.SIG_DFL)
    yield
    for number in ours:
        if signal.getsignal(number) != before[number]:
            signal.signal(number, before[number])


@pytest.fixture
def survived(monkeypatch: pytest.MonkeyPatch) -> Recorder:
    """Signals do not do what they do: this process is to live."""
    survived = Recorder()
    monkeypatch.setattr(process_signals, "_let_it", lambda number, _: survived(number))
    return survived


@pytest.fixture
def as_on_windows(monkeypatch: pytest.MonkeyPatch) -> int:
    """The number of Ctrl-Break, which is that of another signal here."""
    monkeypatch.delattr(signal, "SIGTTIN")
    monkeypatch.setattr(signal, "SIGBREAK", 21, raising=False)
    return 21
