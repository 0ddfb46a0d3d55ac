"""The thread that hears a bus: nothing is lost, and a bus that goes away comes back."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from pathlib import Path
from uuid import uuid4

import can
import pytest
from can.interfaces.virtual import VirtualBus
from monitor.monitored import frame

from swapcan import Codec
from typedcan.monitor.listener import Listener
from typedcan.monitor.session import Session
from typedcan.monitor.watch import Watch
from typedcan.node.clock import SystemClock
from typedcan.node.events import BusBack, BusLost


def wait_for(condition: Callable[[], bool]) -> None:
    """Wait until something is so, ten seconds at most."""
    deadline = time.monotonic() + 10
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.005)


class Breakable(VirtualBus):
    """A bus that raises an error for as long as it has one."""

    trouble: BaseException | None = None

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        if self.trouble:
            raise self.trouble
        return super()._recv_internal(timeout)


def new_session() -> Session:
    clock = SystemClock()
    return Session(Watch(clock.now(), Codec()), clock)


def test_every_frame_of_a_burst_is_counted_and_recorded(tmp_path: Path) -> None:
    channel, session = f"test-{uuid4()}", new_session()
    path = tmp_path / "drive.blf"
    session.record(path)
    with can.Bus(channel, "virtual") as near, can.Bus(channel, "virtual") as far:
        with Listener(near, session):
            for n in range(2000):
                far.send(frame("B2V_ST2", 0, Current=n))
                if n % 100 == 0:
                    session.picture()
            wait_for(lambda: session.status().frames == 2000)
        session.stop_recording()
    with can.LogReader(path) as log:
        assert len(list(log)) == 2000


def test_a_bus_that_is_lost_is_told_and_heard_again_once_it_is_back() -> None:
    channel, session = f"test-{uuid4()}", new_session()
    with Breakable(channel) as near, can.Bus(channel, "virtual") as far, Listener(near, session):
        near.trouble = can.CanOperationError("adapter is gone")
        wait_for(lambda: session.status().bus_lost == "adapter is gone")
        near.trouble = None
        wait_for(lambda: session.status().bus_lost == "")
        far.send(frame("B2V_ST2", 0))
        wait_for(lambda: session.status().messages == 1)
    told = [type(each.event) for each in session.events()]
    assert [kind for kind in told if kind in (BusLost, BusBack)] == [BusLost, BusBack]


def test_a_bus_is_opened_anew_where_the_lost_one_stays_lost() -> None:
    channel, session = f"test-{uuid4()}", new_session()
    with Breakable(channel) as near, can.Bus(channel, "virtual") as far:
        near.trouble = OSError("no such device")
        with Listener(near, session, reopen=lambda: can.Bus(channel, "virtual")):
            told: list[type] = []

            def is_back() -> bool:
                told.extend(type(each.event) for each in session.events())
                return told == [BusLost, BusBack]

            wait_for(is_back)
            far.send(frame("B2V_ST2", 0))
            wait_for(lambda: session.status().messages == 1)


class DriverError(Exception):
    """What no interface should raise."""


@pytest.mark.parametrize("error", [DriverError("odd"), IndexError("list index out of range")])
def test_whatever_a_bus_raises_counts_as_lost(error: Exception) -> None:
    channel, session = f"test-{uuid4()}", new_session()
    with Breakable(channel) as near, can.Bus(channel, "virtual") as far, Listener(near, session):
        near.trouble = error
        wait_for(lambda: str(error) in session.status().bus_lost)
        near.trouble = None
        wait_for(lambda: session.status().bus_lost == "")
        far.send(frame("B2V_ST2", 0))
        wait_for(lambda: session.status().messages == 1)


def test_what_is_no_trouble_of_a_bus_is_raised_in_the_end() -> None:
    def hear_until_it_ends() -> None:
        with (
            Breakable(f"test-{uuid4()}") as bus,
            Listener(bus, new_session()) as listener,
        ):
            bus.trouble = GeneratorExit()
            wait_for(lambda: listener.has_ended)

    with pytest.raises(GeneratorExit):
        hear_until_it_ends()


def test_no_thread_is_left() -> None:
    before = set(threading.enumerate())
    with can.Bus(f"test-{uuid4()}", "virtual") as bus, Listener(bus, new_session()):
        assert set(threading.enumerate()) != before
    assert set(threading.enumerate()) == before
