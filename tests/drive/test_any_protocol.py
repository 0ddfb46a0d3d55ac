"""Driving a bus of somebody else's protocol, whose model says which codes act."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from contextlib import ExitStack

import can
import pytest
from drive.crane_rig import Rig
from node.rough_bus import raising
from simulate.crane import (
    BEACON,
    BRAKE,
    CODEC,
    DOWN,
    LIFT,
    STOP,
    UP,
    VALVE,
    lift_bytes,
    lift_frame,
)

from typedcan.drive.departure import Departure
from typedcan.drive.driving import LEAVING, BusyBusError, Left, look_out_time
from typedcan.drive.noting_bus import EndedError, NotingBus
from typedcan.node.clock import SimulatedClock
from typedcan.simulate.simulated_bus import SimulatedBus, SimulatedWire


@pytest.fixture
def rig() -> Iterator[Rig]:
    with ExitStack() as stack:
        yield Rig(stack)


def beacon() -> can.Message:
    """With the number of Lift, in 29 bits, and bytes that would be no Lift."""
    return can.Message(arbitration_id=0x101, is_extended_id=True, data=[1])


def test_the_bus_is_listened_to_for_as_long_as_the_periods_of_a_sender_ask() -> None:
    assert look_out_time([]) == look_out_time([LIFT]) == look_out_time([BEACON]) == 2.0
    assert look_out_time([BRAKE]) == 10.0
    assert look_out_time([LIFT, BRAKE]) == 2.0  # its sender is heard by Lift
    assert look_out_time([BEACON, BRAKE]) == 10.0


def test_nobody_else_is_found_where_the_number_comes_in_the_other_width(rig: Rig) -> None:
    rig.other.send(beacon())
    rig.driving.look_out()
    assert rig.clock.now() == pytest.approx(2.0, abs=0.011)
    assert rig.lifts() == []


def test_another_panel_is_found_before_anything_is_sent(rig: Rig) -> None:
    rig.other.send(lift_frame(STOP))
    with pytest.raises(BusyBusError) as raised:
        rig.driving.look_out()
    assert str(raised.value) == (
        "another PANEL is on the bus: Lift (0x101) comes from somebody else;"
        " nothing is sent beside it"
    )
    assert raised.value.message is LIFT
    assert rig.clock.now() < 0.1


def test_another_panel_that_comes_later_ends_it(rig: Rig) -> None:
    rig.world.at(1.0, lambda: rig.other.send(lift_frame(DOWN)))
    with pytest.raises(BusyBusError):
        rig.driving.live(rig.world, 5.0)
    assert rig.clock.now() < 1.1
    assert rig.winch.moves
    assert rig.driving.leave(rig.departure()) is Left.SAFE
    assert not rig.winch.moves


def test_what_moves_is_told_to_stop_and_is_off_before_the_bus_is_left(rig: Rig) -> None:
    rig.driving.live(rig.world, 2.0)
    assert [message.NAME for message in rig.bus.acting] == ["Lift"]
    before = rig.lifts()
    assert {frame.data[2] for frame in before} == {UP}
    begin = rig.clock.now()
    assert rig.driving.leave(rig.departure()) is Left.SAFE
    assert rig.clock.now() - begin == pytest.approx(0.5, abs=0.051)
    assert not rig.winch.moves
    assert rig.bus.acting == ()
    after = rig.lifts()
    alive = before[-1].data[1]
    for frame in after:  # though the panel wants up to the end
        alive = alive % 15 + 1
        assert bytes(frame.data) == lift_bytes(STOP, alive)
    assert len(after) >= 5


def test_a_report_from_before_the_last_command_proves_nothing(rig: Rig) -> None:
    rig.panel.wanted = STOP
    rig.driving.live(rig.world, 1.0)
    assert rig.is_off()
    rig.bus.send(lift_frame(UP))
    assert not rig.is_off()
    assert rig.bus.has_acted


def test_a_winch_that_does_not_say_that_it_stands_is_not_left_safe(rig: Rig) -> None:
    rig.driving.live(rig.world, 1.0)
    begin = rig.clock.now()
    assert rig.driving.leave(rig.departure(live_on=[rig.panel])) is Left.UNKNOWN
    assert rig.clock.now() - begin == pytest.approx(LEAVING, abs=0.051)


def test_where_nobody_can_tell_it_is_not_left_safe(rig: Rig) -> None:
    rig.driving.live(rig.world, 1.0)
    assert rig.driving.leave(Departure(live_on=[rig.panel, rig.winch])) is Left.UNKNOWN
    assert not rig.winch.moves


def test_what_is_to_be_done_when_leaving_is_tried_whatever_becomes_of_the_rest(rig: Rig) -> None:
    rig.driving.live(rig.world, 1.0)
    done: list[str] = []
    rig.lifts()

    def heal() -> None:
        done.append(f"heal before {len(rig.lifts())}")

    def withdraw() -> None:
        done.append(f"withdraw after {len(rig.lifts())}")
        rig.panel.wanted = STOP

    departure = rig.departure(
        heal=[raising(ZeroDivisionError), heal], withdraw=[raising(KeyError), withdraw]
    )
    assert rig.driving.leave(departure) is Left.SAFE
    assert done == ["heal before 0", "withdraw after 1"]
    assert rig.driving.interrupted is None


def test_who_would_command_again_stands_still_and_its_safe_codes_are_repeated(
    rig: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    rig.driving.live(rig.world, 1.0)
    rig.lifts()
    steps: list[float] = []
    monkeypatch.setattr(rig.panel, "step", steps.append)
    departure = rig.departure(live_on=[rig.winch], stand_still=[rig.panel])
    assert rig.driving.leave(departure) is Left.SAFE
    assert steps == []
    times = [frame.timestamp for frame in rig.lifts() if frame.data[2] == STOP]
    assert len(times) >= 10
    assert max(b - a for a, b in itertools.pairwise(times)) < 0.11


@pytest.fixture
def noting() -> Iterator[tuple[NotingBus, SimulatedBus]]:
    """A bus that notes, and its other end."""
    clock = SimulatedClock()
    wire = SimulatedWire(clock)
    with (
        SimulatedBus(wire) as bus,
        SimulatedBus(wire) as far,
        NotingBus(bus, CODEC, lambda _: None, clock=clock) as noting,
    ):
        yield noting, far


def last_of(bus: can.BusABC) -> can.Message:
    """What came last."""
    found = None
    while frame := bus.recv(0):
        found = frame
    assert found
    return found


def test_the_safe_frame_has_11_bits_the_next_counter_and_its_checksum(
    noting: tuple[NotingBus, SimulatedBus],
) -> None:
    bus, far = noting
    for alive, following in ((3, 4), (15, 1)):
        bus.has_ended = False
        bus.send(lift_frame(UP, alive))
        assert [message.NAME for message in bus.acting] == ["Lift"]
        assert bus.send_safe_codes() is None
        assert bus.acting == ()
        frame = last_of(far)
        assert (frame.arbitration_id, frame.is_extended_id, frame.is_fd) == (0x101, False, False)
        assert bytes(frame.data) == lift_bytes(STOP, following)


def test_the_safe_frame_of_a_can_fd_message_is_one(noting: tuple[NotingBus, SimulatedBus]) -> None:
    bus, far = noting
    bus.send(CODEC.frame(BRAKE(hold=1, force=9)))  # type: ignore[call-arg]
    assert [message.NAME for message in bus.acting] == ["Brake"]
    bus.send_safe_codes()
    frame = last_of(far)
    assert (frame.is_fd, frame.bitrate_switch) == (True, True)
    assert bytes(frame.data) == bytes(9) + b"\x09\x00\x00"


def test_the_same_number_in_29_bits_commands_nothing(
    noting: tuple[NotingBus, SimulatedBus],
) -> None:
    bus, far = noting
    bus.send(can.Message(arbitration_id=0x101, is_extended_id=True, data=lift_bytes(UP, 1)))
    assert bus.acting == ()
    assert not bus.has_acted
    bus.send_safe_codes()
    assert last_of(far).is_extended_id


def test_after_the_end_nothing_that_acts_goes_out_and_all_else_does(
    noting: tuple[NotingBus, SimulatedBus],
) -> None:
    bus, far = noting
    bus.send_safe_codes()
    with pytest.raises(EndedError, match="Lift would act"):
        bus.send(lift_frame(DOWN))
    bus.send(lift_frame(STOP, 2))
    assert bytes(last_of(far).data) == lift_bytes(STOP, 2)


def test_what_is_known_by_its_pgn_is_ended_at_each_address_that_it_was_sent_to(
    noting: tuple[NotingBus, SimulatedBus],
) -> None:
    bus, far = noting
    for number, code in ((0x0CEF2180, 1), (0x18EF2281, 1), (0x0CEF2380, 0), (0x0CEF2180, 1)):
        bus.send(can.Message(arbitration_id=number, data=[code, *bytes(7)]))
    assert [message.NAME for message in bus.acting] == ["Valve", "Valve"]
    bus.send(can.Message(arbitration_id=0x18EF2281, data=bytes(8)))
    assert [message.NAME for message in bus.acting] == ["Valve"]
    while far.recv(0):
        pass
    assert bus.send_safe_codes() is None
    assert bus.acting == ()
    shut = [(frame.arbitration_id, bytes(frame.data)) for frame in iter(lambda: far.recv(0), None)]
    assert shut == [(number, bytes(8)) for number in (0x0CEF2180, 0x18EF2281, 0x0CEF2380)]
    with pytest.raises(EndedError):
        bus.send(can.Message(arbitration_id=0x0CEF2480, data=[1, *bytes(7)]))


def test_another_who_sends_what_is_known_by_its_pgn_is_found_whatever_its_address() -> None:
    clock = SimulatedClock()
    wire = SimulatedWire(clock)
    with (
        SimulatedBus(wire) as bus,
        SimulatedBus(wire) as far,
        NotingBus(bus, CODEC, lambda _: None, clock=clock, played=[VALVE]) as noting,
    ):
        far.send(can.Message(arbitration_id=0x0CF02180, data=bytes(8)))
        noting.recv(0)
        assert noting.intruder is None
        far.send(can.Message(arbitration_id=0x18EF2142, data=bytes(8)))
        noting.recv(0)
        assert noting.intruder is VALVE
