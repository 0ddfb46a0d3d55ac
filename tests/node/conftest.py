"""Nodes driven by hand, and proof that no thread outlives a test."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from pathlib import Path

import can
import pytest
from commands.running import bus_options
from node.bench import Bench, Ear
from node.programs import Program, running
from node.rough_bus import Hang, RoughBus, made_rough


@pytest.fixture(autouse=True)
def no_thread_is_left() -> Iterator[None]:
    before = set(threading.enumerate())
    yield
    left = [thread for thread in threading.enumerate() if thread not in before]
    assert left == []


@pytest.fixture
def bench() -> Bench:
    return Bench()


@pytest.fixture
def rough(near: can.BusABC) -> RoughBus:
    """`near`, which fails and hangs as it is told to."""
    return made_rough(near)


@pytest.fixture
def hang() -> Iterator[Hang]:
    """Hangs until the test is over, which then waits for the threads of nodes."""
    hang = Hang()
    yield hang
    hang.release()
    for thread in threading.enumerate():
        if thread.name.startswith("typedcan"):
            thread.join(30.0)


@pytest.fixture
def hurried_leaving(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where many nodes are left in a row: how the safe codes are spread is tested elsewhere."""
    monkeypatch.setattr("typedcan.node.leaving._BETWEEN", 0.002)


@pytest.fixture
def ear(bench: Bench, far: can.BusABC) -> Ear:
    return Ear(bench, far)


@pytest.fixture
def program(tmp_path: Path) -> Iterator[Callable[[str], AbstractContextManager[Program]]]:
    """Runs a program with a bus that processes share."""
    options = bus_options("udp_multicast")
    with can.Bus(ignore_config=True, **options) as bus:
        yield lambda text: running(text, options, bus, tmp_path)
