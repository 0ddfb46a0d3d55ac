"""Nodes driven by hand, and proof that no thread outlives a test."""

from __future__ import annotations

import threading
from collections.abc import Iterator

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
def bench() -> Bench:
    return Bench()


@pytest.fixture
def ear(bench: Bench, far: can.BusABC) -> Ear:
    return Ear(bench, far)
