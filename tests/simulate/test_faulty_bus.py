"""A bus with faults: each one does to the frames what its name says, and nothing else."""

from __future__ import annotations

from collections.abc import Iterator
from functools import reduce
from operator import xor

import can
import pytest
from defaults import default_of

from swapcan import Link
from swapcan.messages import B2V_ST1, B2V_ST2, BMS_TMS_0, BSU_BMS_0, V2B_CMD, V2B_RQData
from swapcan.nodes.faults import FaultyBus
from typedcan.node.clock import SimulatedClock
from typedcan.simulate.simulated_bus import SimulatedBus, SimulatedWire
from typedcan.simulate.times import PlanError


@pytest.fixture
def clock() -> SimulatedClock:
    return SimulatedClock()


@pytest.fixture
def wire(clock: SimulatedClock) -> SimulatedWire:
    return SimulatedWire(clock)


@pytest.fixture
def far(wire: SimulatedWire) -> Iterator[can.BusABC]:
    with SimulatedBus(wire) as bus:
        yield bus


@pytest.fixture
def faulty(wire: SimulatedWire, clock: SimulatedClock, far: can.BusABC) -> Iterator[FaultyBus]:
    with FaultyBus(SimulatedBus(wire), clock=clock) as bus:
        yield bus


@pytest.fixture
def link(faulty: FaultyBus) -> Link:
    return Link(faulty)


def arrived(bus: can.BusABC) -> list[can.Message]:
    frames = []
    while frame := bus.recv(0):
        frames.append(frame)
    return frames


def counters(frames: list[can.Message]) -> list[int]:
    """The alive counters of B2V_ST1: the low half of byte 1."""
    return [frame.data[1] & 0x0F for frame in frames]


def test_without_a_fault_frames_pass_as_they_are(faulty: FaultyBus, far: can.BusABC) -> None:
    sent = can.Message(arbitration_id=0x1881D0F3, data=[1, 1, 0, 0, 0, 0, 0, 0])
    faulty.send(sent)
    (received,) = arrived(far)
    assert (received.arbitration_id, received.data) == (sent.arbitration_id, sent.data)


def test_one_frame_in_four_is_lost_and_the_first_is_among_them(
    faulty: FaultyBus, link: Link, far: can.BusABC
) -> None:
    faulty.inject("lost_frame")
    for _ in range(9):
        link.send(B2V_ST1())
    assert counters(arrived(far)) == [1, 2, 3, 5, 6, 7]


def test_lost_frames_are_counted_for_each_message(
    faulty: FaultyBus, link: Link, far: can.BusABC
) -> None:
    faulty.inject("lost_frame", every=2)
    for _ in range(3):
        link.send(B2V_ST1())
        link.send(B2V_ST2())
    assert [frame.arbitration_id for frame in arrived(far)] == [0x1881D0F3, 0x1882D0F3]


def test_a_fault_can_be_for_some_messages_only(
    faulty: FaultyBus, link: Link, far: can.BusABC
) -> None:
    faulty.inject("bus_silence", B2V_ST2)
    link.send(B2V_ST1())
    link.send(B2V_ST2())
    assert [frame.arbitration_id for frame in arrived(far)] == [0x1881D0F3]


def test_the_faults_of_two_messages_do_not_end_each_other(
    faulty: FaultyBus, link: Link, far: can.BusABC
) -> None:
    faulty.inject("bus_silence", B2V_ST1)
    faulty.inject("bus_silence", B2V_ST2)
    faulty.heal("bus_silence", B2V_ST2)
    link.send(B2V_ST1())
    link.send(B2V_ST2())
    assert [frame.arbitration_id for frame in arrived(far)] == [0x1882D0F3]
    faulty.heal("bus_silence")
    assert faulty.active_faults == frozenset()


def test_a_stuck_counter_stays_as_it_was_and_the_checksum_is_right(
    faulty: FaultyBus, link: Link, far: can.BusABC
) -> None:
    link.send(B2V_ST1())
    faulty.inject("stuck_counter")
    for _ in range(3):
        link.send(B2V_ST1(flt_fire=1))
    faulty.heal("stuck_counter")
    link.send(B2V_ST1())
    frames = arrived(far)
    assert counters(frames) == [0, 1, 1, 1, 4]
    assert all(frame.data[0] == reduce(xor, frame.data[1:]) for frame in frames)


@pytest.mark.parametrize(
    ("message", "byte"), [(BSU_BMS_0(), 0), (default_of(BMS_TMS_0), 6), (V2B_CMD(), 1)], ids=str
)
def test_each_message_with_a_counter_can_have_it_stuck(
    faulty: FaultyBus,
    link: Link,
    far: can.BusABC,
    message: BSU_BMS_0 | BMS_TMS_0 | V2B_CMD,
    byte: int,
) -> None:
    faulty.inject("stuck_counter", type(message))
    for _ in range(3):
        link.send(message)
    assert len({frame.data[byte] for frame in arrived(far)}) == 1


def test_a_wrong_checksum_changes_the_checksum_alone(
    faulty: FaultyBus, link: Link, far: can.BusABC
) -> None:
    faulty.inject("wrong_checksum", every=2)
    for _ in range(2):
        link.send(V2B_RQData())
    wrong, right = arrived(far)
    assert wrong.data[1:] == right.data[1:]
    assert right.data[0] == reduce(xor, right.data[1:])
    assert wrong.data[0] != right.data[0]


def test_silence_holds_everything_back_and_ends_when_it_is_healed(
    faulty: FaultyBus, link: Link, far: can.BusABC
) -> None:
    faulty.inject("bus_silence")
    link.send(B2V_ST1())
    faulty.send(can.Message(arbitration_id=0x123, is_extended_id=False))
    assert arrived(far) == []
    assert faulty.active_faults == {"bus_silence"}
    faulty.heal("bus_silence")
    assert faulty.active_faults == frozenset()
    link.send(B2V_ST1())
    assert counters(arrived(far)) == [1]


def test_a_late_frame_comes_two_and_a_half_periods_later(
    faulty: FaultyBus, link: Link, far: can.BusABC, clock: SimulatedClock
) -> None:
    faulty.inject("late_frame")
    link.send(B2V_ST1())
    clock.advance_to(0.249)
    faulty.recv(0)
    assert arrived(far) == []
    clock.advance_to(0.25)
    faulty.recv(0)
    (received,) = arrived(far)
    assert received.timestamp == 0.25


def test_frames_of_a_message_keep_their_order_behind_a_late_one(
    faulty: FaultyBus, link: Link, far: can.BusABC, clock: SimulatedClock
) -> None:
    faulty.inject("late_frame", B2V_ST1)
    for tenth in range(3):
        clock.advance_to(tenth / 10)
        link.send(B2V_ST1())
        link.send(B2V_ST2())
    clock.advance_to(0.3)
    link.send(B2V_ST1())
    frames = [frame for frame in arrived(far) if frame.arbitration_id == 0x1881D0F3]
    assert counters(frames) == [0, 1, 2, 3]
    assert [frame.timestamp for frame in frames] == [0.3] * 4


def test_other_messages_are_not_late(
    faulty: FaultyBus, link: Link, far: can.BusABC, clock: SimulatedClock
) -> None:
    faulty.inject("late_frame", B2V_ST1)
    link.send(B2V_ST1())
    link.send(B2V_ST2())
    assert [frame.arbitration_id for frame in arrived(far)] == [0x1882D0F3]


def test_waiting_to_receive_does_not_keep_a_late_frame_back() -> None:
    with (
        can.Bus("late", "virtual", ignore_config=True) as far,
        FaultyBus(can.Bus("late", "virtual", ignore_config=True)) as faulty,
    ):
        faulty.inject("late_frame", V2B_CMD)  # 0.125 s late
        Link(faulty).send(V2B_CMD())
        assert far.recv(0) is None
        faulty.recv(0.2)
        assert far.recv(0) is not None


def test_what_is_received_is_not_touched(faulty: FaultyBus, far: can.BusABC) -> None:
    for fault in ("lost_frame", "late_frame", "stuck_counter", "wrong_checksum", "bus_silence"):
        faulty.inject(fault, every=1)
    far.send(can.Message(arbitration_id=0x1881D0F3, data=[1, 1, 0, 0, 0, 0, 0, 0]))
    received = faulty.recv(0)
    assert received is not None
    assert received.data.hex() == "0101000000000000"


def test_frames_that_the_filters_reject_do_not_hide_those_behind_them(
    faulty: FaultyBus, far: can.BusABC
) -> None:
    faulty.set_filters([{"can_id": 0x200, "can_mask": 0x1FFFFFFF, "extended": True}])
    for number in (0x100, 0x101, 0x200, 0x102):
        far.send(can.Message(arbitration_id=number))
    received = faulty.recv(0)
    assert received is not None
    assert received.arbitration_id == 0x200
    assert faulty.recv(0) is None


def test_foreign_and_broken_frames_pass_where_no_counter_can_be_found(
    faulty: FaultyBus, far: can.BusABC
) -> None:
    faulty.inject("stuck_counter")
    faulty.inject("wrong_checksum", every=1)
    for frame in (
        can.Message(arbitration_id=0x1881D0F3, data=[1, 2, 3]),
        can.Message(arbitration_id=0x18FEF100, data=bytes(8)),
        can.Message(arbitration_id=0x1881D0F3, is_remote_frame=True, dlc=8),
    ):
        faulty.send(frame)
        (received,) = arrived(far)
        assert (received.arbitration_id, received.data) == (frame.arbitration_id, frame.data)


@pytest.mark.parametrize(
    ("fault", "messages", "reason"),
    [
        ("over_temperature", (), "frames cannot have the fault 'over_temperature'; known: "),
        ("stuck_counter", (B2V_ST2,), "the frames of B2V_ST2 cannot have stuck_counter"),
        ("wrong_checksum", (BSU_BMS_0,), "the frames of BSU_BMS_0 cannot have wrong_checksum"),
    ],
)
def test_a_fault_that_frames_cannot_have_is_refused(
    faulty: FaultyBus, fault: str, messages: tuple[type[B2V_ST2]], reason: str
) -> None:
    with pytest.raises(PlanError, match=reason):
        faulty.inject(fault, *messages)
    assert faulty.active_faults == frozenset()


def test_shutting_it_down_shuts_down_the_other_bus(wire: SimulatedWire) -> None:
    inner = SimulatedBus(wire)
    FaultyBus(inner).shutdown()
    with pytest.raises(can.CanOperationError):
        inner.recv(0)
