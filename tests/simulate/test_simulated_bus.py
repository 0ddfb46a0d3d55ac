"""Simulated buses carry frames as a wire does, with the timestamps of a given clock."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack

import can
import pytest

from typedcan.node.clock import SimulatedClock
from typedcan.simulate.simulated_bus import SimulatedBus, SimulatedWire


@pytest.fixture
def clock() -> SimulatedClock:
    return SimulatedClock()


@pytest.fixture
def buses(clock: SimulatedClock) -> Iterator[tuple[SimulatedBus, SimulatedBus, SimulatedBus]]:
    wire = SimulatedWire(clock)
    with ExitStack() as stack:
        one, two, three = (stack.enter_context(SimulatedBus(wire)) for _ in range(3))
        yield one, two, three


Buses = tuple[SimulatedBus, SimulatedBus, SimulatedBus]


def frame(number: int = 0x18FFF8A7, *data: int) -> can.Message:
    return can.Message(arbitration_id=number, is_extended_id=True, data=data, is_rx=False)


def test_a_frame_reaches_all_buses_but_its_senders(buses: Buses) -> None:
    one, two, three = buses
    one.send(frame(0x18FFF8A7, 1, 2))
    for bus in (two, three):
        received = bus.recv(0)
        assert received is not None
        assert (received.arbitration_id, bytes(received.data)) == (0x18FFF8A7, b"\x01\x02")
        assert received.is_rx
        assert bus.recv(0) is None
    assert one.recv(0) is None


def test_timestamps_are_the_clocks(buses: Buses, clock: SimulatedClock) -> None:
    one, two, _ = buses
    clock.advance_to(86_400.5)
    one.send(frame())
    received = two.recv(0)
    assert received is not None
    assert received.timestamp == 86_400.5


def test_frames_arrive_in_the_order_in_which_they_were_sent(buses: Buses) -> None:
    one, two, three = buses
    for number in range(5):
        (one if number % 2 else two).send(frame(0x100 + number))
    order = [received.arbitration_id for _ in range(5) if (received := three.recv(0))]
    assert order == [0x100, 0x101, 0x102, 0x103, 0x104]


def test_a_changed_copy_changes_nobody_elses(buses: Buses) -> None:
    one, two, three = buses
    sent = frame(0x100, 1)
    one.send(sent)
    first = two.recv(0)
    assert first is not None
    first.timestamp = 99.0
    second = three.recv(0)
    assert second is not None
    assert second.timestamp == 0.0
    assert sent.timestamp == 0.0


def test_filters_hold(buses: Buses) -> None:
    one, two, _ = buses
    two.set_filters([{"can_id": 0x200, "can_mask": 0x1FFFFFFF, "extended": True}])
    one.send(frame(0x100))
    one.send(frame(0x200))
    received = two.recv(0)
    assert received is not None
    assert received.arbitration_id == 0x200
    assert two.recv(0) is None


def test_a_bus_that_is_shut_down_is_off_the_wire(buses: Buses) -> None:
    one, two, three = buses
    two.shutdown()
    one.send(frame())
    assert three.recv(0) is not None
    with pytest.raises(can.CanOperationError, match="shut down"):
        two.send(frame())
    with pytest.raises(can.CanOperationError, match="shut down"):
        two.recv(0)


def test_waiting_for_a_frame_ends_after_the_timeout(buses: Buses) -> None:
    assert buses[0].recv(0.01) is None
