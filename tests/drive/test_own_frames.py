"""Whose frames those are that arrive, and when they came."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable

import can
import pytest
from drive.trouble import SCENARIO
from scenarios.rig import bench

from swapcan import encode
from swapcan.messages import V2B_CMD, HvCommand
from swapcan.scenarios.scenario import ScenarioError
from swapcan.scenarios.stage import Left
from swapcan.wire import Codec
from typedcan.drive.noting_bus import NotingBus
from typedcan.node.clock import SimulatedClock

NUMBER = V2B_CMD.FRAME_ID
OWN = encode(V2B_CMD(hv_on_off=HvCommand.HV_OFF, vehicle_speed=0.0), counter=3)


class Given(can.BusABC):
    """A bus on which given frames arrive, and nothing where there is None."""

    def __init__(self, *frames: can.Message | None) -> None:
        self.frames = list(frames)
        super().__init__(channel="given")

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Drop it."""

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        return (self.frames.pop(0) if self.frames else None), False


def own(*, is_rx: bool = True) -> can.Message:
    return can.Message(arbitration_id=NUMBER, data=OWN, is_rx=is_rx)


def intruder(seconds: Iterable[float], *arrive: can.Message | None) -> bool:
    """Whether frames count as another's that arrive so many seconds after one's own was sent."""
    clock = SimulatedClock(10.0)
    with (
        Given(*arrive) as bus,
        NotingBus(bus, Codec(), lambda _: None, clock=clock, played=[V2B_CMD]) as noting,
    ):
        noting.send(own())
        for second in seconds:
            clock.advance_to(10.0 + second)
            noting.recv(0)
        return noting.intruder is not None


def test_what_comes_back_is_ones_own_also_to_a_process_that_was_held_up() -> None:
    assert not intruder([0.1], own())
    assert not intruder([4.9], own())
    assert intruder([5.1], own())
    assert intruder([0.1, 0.2], own(), own())


def test_where_nothing_comes_back_at_first_the_same_bytes_are_anothers() -> None:
    assert intruder([0.6, 0.7], None, own())
    assert not intruder([0.4, 0.45], None, own())  # it may be late


def test_an_interface_that_has_given_back_one_frame_may_lose_the_next() -> None:
    clock = SimulatedClock()
    with (
        Given(own(), None, own()) as bus,
        NotingBus(bus, Codec(), lambda _: None, clock=clock, played=[V2B_CMD]) as noting,
    ):
        noting.send(own())
        noting.recv(0)
        noting.send(own())
        clock.advance_to(1.0)
        assert noting.recv(0) is None
        noting.recv(0)
        assert noting.intruder is None


def test_what_another_program_of_this_machine_sends_is_not_ones_own() -> None:
    # SocketCAN gives such frames with the flag of those that were not received.
    other = can.Message(arbitration_id=NUMBER, data=bytes(8), is_rx=False)
    assert intruder([0.1], other)
    noted: list[can.Message] = []
    with (
        Given(other) as bus,
        NotingBus(bus, Codec(), noted.append, clock=SimulatedClock()) as noting,
    ):
        assert noting.recv(0)
    assert [each.is_rx for each in noted] == [True]


def test_another_truck_is_noticed_though_it_sends_the_same_as_is_played() -> None:
    with bench() as rig:
        seen: list[can.Message] = []

        def repeat(frame: can.Message) -> None:
            if frame.arbitration_id == NUMBER and not frame.is_rx:
                seen.append(frame)
                if len(seen) > 20:
                    rig.outside.send(can.Message(arbitration_id=NUMBER, data=seen[-15].data))

        stage = rig.stage()
        with pytest.raises(ScenarioError, match=r"^another VCU is on the bus"):
            stage.play(SCENARIO, ["VCU"], repeat)
        assert stage.left is Left.SAFE


IMPOSSIBLE = (math.inf, -math.inf, math.nan, -1.0, 1e300, 2.0**40)


@pytest.mark.parametrize("second", IMPOSSIBLE)
def test_an_impossible_time_is_the_time_of_arrival_and_spoils_no_other(second: float) -> None:
    noted: list[can.Message] = []
    arrive = [
        can.Message(arbitration_id=1 + number, timestamp=each)
        for number, each in enumerate((second, 5.0, second, 5.25))
    ]
    clock = SimulatedClock(1000.0)
    with Given(*arrive) as bus, NotingBus(bus, Codec(), noted.append, clock=clock) as noting:
        while noting.recv(0):
            pass
    assert sorted((each.arbitration_id, each.timestamp) for each in noted) == [
        (1, 1000.0),
        (2, 1000.0),
        (3, 1000.0),
        (4, 1000.25),
    ]


def noted_at(clock: SimulatedClock, *arrive: can.Message) -> list[float]:
    """The times that frames are noted with."""
    noted: list[can.Message] = []
    with Given(*arrive) as bus, NotingBus(bus, Codec(), noted.append, clock=clock) as noting:
        while noting.recv(0):
            pass
    return [each.timestamp for each in sorted(noted, key=lambda each: each.arbitration_id)]


def at(number: int, second: float) -> can.Message:
    return can.Message(arbitration_id=number, timestamp=second)


def test_an_adapter_may_count_from_when_it_was_plugged_in() -> None:
    assert noted_at(SimulatedClock(5000.0), at(1, 0.5), at(2, 0.75)) == [5000.0, 5000.25]


def test_a_time_that_leaps_by_hours_is_the_time_of_arrival() -> None:
    found = noted_at(SimulatedClock(5000.0), at(1, 5.0), at(2, 9000.0), at(3, 5.5))
    assert found == [5000.0, 5000.0, 5000.5]


def test_frames_without_a_time_have_each_that_of_their_arrival() -> None:
    clock = SimulatedClock(10.0)
    noted: list[can.Message] = []
    with (
        Given(at(1, 0.0), at(2, 0.0)) as bus,
        NotingBus(bus, Codec(), noted.append, clock=clock) as noting,
    ):
        assert noting.recv(0)
        clock.advance_to(12.0)
        assert noting.recv(0)
    assert [each.timestamp for each in noted] == [10.0, 12.0]


def test_in_real_time_both_directions_have_the_time_of_day() -> None:
    noted: list[can.Message] = []
    second = time.time() - 0.01
    with Given(at(1, second)) as bus, NotingBus(bus, Codec(), noted.append) as noting:
        assert noting.recv(0)
        noting.send(own())
    assert noted[0].timestamp == second
    assert noted[1].timestamp == pytest.approx(time.time(), abs=30.0)
