"""Virtual buses of one test, and proof that no thread outlives it."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from uuid import uuid4

import can
import pytest
from node.bench import Bench, Ear


@pytest.fixture(autouse=True)
def no_thread_is_left() -> Iterator[None]:
    before = set(threading.enumerate())
    yield
    left = [thread for thread in threading.enumerate() if thread not in before]
    assert left == []


@pytest.fixture
def open_bus() -> Iterator[Callable[..., can.BusABC]]:
    """Opens buses on a channel that nobody else has, and closes them after the test."""
    channel = f"test-{uuid4()}"
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
def bench() -> Bench:
    return Bench()


@pytest.fixture
def ear(bench: Bench, far: can.BusABC) -> Ear:
    return Ear(bench, far)
