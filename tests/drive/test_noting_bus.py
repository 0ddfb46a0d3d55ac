"""The bus that notes what it carries: order, times, and what is told of it."""

from __future__ import annotations

from collections.abc import Iterator

import can
import pytest

from swapcan.messages import V2B_CMD
from swapcan.wire import Codec
from typedcan.drive.noting_bus import NotingBus
from typedcan.node.clock import SimulatedClock, SystemClock
from typedcan.simulate.simulated_bus import SimulatedBus, SimulatedWire


class Given(can.BusABC):
    """A bus on which given frames arrive."""

    def __init__(self, *frames: can.Message) -> None:
        self.frames = list(frames)
        super().__init__(channel="given")

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Drop it."""

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        return (self.frames.pop(0) if self.frames else None), False


def frame(number: int, second: float = 0.0) -> can.Message:
    """A frame of somebody."""
    return can.Message(arbitration_id=number, timestamp=second, channel="can7")


def noted(*frames: can.Message, clock: SimulatedClock | SystemClock) -> list[can.Message]:
    """What is noted of frames that arrive."""
    found: list[can.Message] = []
    with Given(*frames) as bus, NotingBus(bus, Codec(), found.append, clock=clock) as noting:
        while noting.recv(0):
            pass
    return found


def test_frames_are_noted_in_the_order_of_their_times() -> None:
    found = noted(frame(1, 10.0), frame(3, 10.05), frame(2, 10.02), clock=SimulatedClock(10.06))
    assert [each.arbitration_id for each in found] == [1, 2, 3]
    assert [each.timestamp for each in found] == [10.0, 10.02, 10.05]


def test_the_time_of_an_adapter_that_has_its_own_is_moved_and_keeps_its_steps() -> None:
    found = noted(frame(1, 5.0), frame(2, 5.25), frame(3, 7.0), clock=SimulatedClock(1000.0))
    assert [each.timestamp for each in found] == [1000.0, 1000.25, 1002.0]


def test_a_frame_without_a_time_has_the_time_of_its_arrival() -> None:
    found = noted(frame(1), frame(2), clock=SimulatedClock(1000.0))
    assert [each.timestamp for each in found] == [1000.0, 1000.0]


def test_what_is_sent_has_the_time_that_the_adapter_would_give_it() -> None:
    found: list[can.Message] = []
    clock = SimulatedClock(10.0)
    # The adapter's clock is 0.4 s behind, and the second frame waited 10 ms to be read.
    with (
        Given(frame(1, 9.6), frame(2, 9.59)) as bus,
        NotingBus(bus, Codec(), found.append, clock=clock) as noting,
    ):
        assert noting.recv(0)
        assert noting.recv(0)
        clock.advance_to(10.1)
        noting.send(frame(3))
    assert [each.arbitration_id for each in found] == [2, 1, 3]
    assert found[-1].timestamp == pytest.approx(9.7)


def test_frames_of_both_directions_are_on_one_channel_with_their_direction() -> None:
    found: list[can.Message] = []
    with Given(frame(1, 10.0)) as bus:
        with NotingBus(bus, Codec(), found.append, clock=SimulatedClock(10.0)) as noting:
            received = noting.recv(0)
            noting.send(frame(2))
        assert received
        assert received.channel == "can7"  # what nodes see stays as it is
    assert [(each.arbitration_id, each.is_rx, each.channel) for each in found] == [
        (1, True, None),
        (2, False, None),
    ]


@pytest.fixture
def wire() -> Iterator[tuple[SimulatedBus, SimulatedBus]]:
    """Two ends."""
    shared = SimulatedWire(SimulatedClock())
    with SimulatedBus(shared) as one, SimulatedBus(shared) as two:
        yield one, two


def test_who_sends_what_is_played_is_an_intruder_and_the_own_echo_is_not(
    wire: tuple[SimulatedBus, SimulatedBus],
) -> None:
    one, two = wire
    clock = SimulatedClock()
    with NotingBus(one, Codec(), lambda _: None, clock=clock, played=[V2B_CMD]) as noting:
        own = can.Message(arbitration_id=0x1802F3D0, data=b"\x01")
        noting.send(own)
        two.send(own)  # as an interface does that gives back what was sent
        assert noting.recv(0) is None
        assert noting.intruder is None
        two.send(own)
        assert noting.recv(0)
        assert noting.intruder


def test_the_lent_bus_stays_open(wire: tuple[SimulatedBus, SimulatedBus]) -> None:
    one, two = wire
    with NotingBus(one, Codec(), lambda _: None, clock=SimulatedClock()):
        pass
    one.send(frame(1))
    assert two.recv(0)
