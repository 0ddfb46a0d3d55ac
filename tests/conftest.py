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

from dbcspec.config import find_config
from dbcspec.project import Project, load
from typedcan.model.protocol import Protocol

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
