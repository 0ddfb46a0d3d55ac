"""Virtual buses, and the command line as users start it."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from uuid import uuid4

import can
import pytest

import swapcan

SOURCE = Path(swapcan.__file__).parents[1]


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
def environment() -> dict[str, str]:
    """For processes: the package under test, and nothing that changes it or python-can."""
    kept = {
        name: value
        for name, value in os.environ.items()
        if not name.startswith("CAN_") and name != "PYTHONUNBUFFERED"
    }
    paths = [str(SOURCE), *filter(None, [os.environ.get("PYTHONPATH")])]
    return kept | {"PYTHONPATH": os.pathsep.join(paths)}


@pytest.fixture
def swapcan_command(environment: dict[str, str]) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Runs `python -m swapcan` to its end."""

    def run(*arguments: str, **variables: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-m", "swapcan", *arguments],
            env=environment | variables,
            capture_output=True,
            encoding="utf-8",
            timeout=30,
            check=False,
        )

    return run
