"""Frames whose bytes are tampered with, through the receiver to the counts of supervision."""

from collections.abc import Iterable

import can
from supervise.arrivals import frame

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import B2V_ST1
from swapcan.wire import Receiver
from typedcan.supervise import State, SupervisionEvent, Supervisor
from typedcan.wire.link import Received

NO_FAULTS = {
    "length": 0,
    "checksum": 0,
    "counter repeated": 0,
    "counter skipped": 0,
    "counter invalid": 0,
    "format": 0,
}


def faults_of(frames: Iterable[can.Message], message: str = "B2V_ST1") -> dict[str, int]:
    """The counts after these frames have come, 100 ms apart."""
    receiver, supervisor = Receiver(), Supervisor(PROTOCOL, "VCU")
    for n, one in enumerate(frames):
        taken = receiver.take(one)
        if isinstance(taken, Received):
            supervisor.take(taken, n * 0.1)
        elif taken:
            supervisor.fault(taken, n * 0.1)
    (found,) = (m for m in supervisor.snapshot(60.0).messages if m.name == message)
    return dict(found.faults)


def counting(*counters: int) -> list[can.Message]:
    return [frame("B2V_ST1", ALIV=counter) for counter in counters]


def test_a_counter_that_runs_from_0_to_14_has_no_fault() -> None:
    assert faults_of(counting(*range(15), *range(15), 0)) == NO_FAULTS


def test_each_repeated_counter_is_counted() -> None:
    assert faults_of(counting(3, 3, 3, 4)) == NO_FAULTS | {"counter repeated": 2}


def test_a_lost_frame_is_one_skipped_counter() -> None:
    assert faults_of(counting(3, 5, 6, 7)) == NO_FAULTS | {"counter skipped": 1}


def test_a_counter_of_15_is_invalid_and_nothing_else() -> None:
    assert faults_of(counting(3, 15, 4)) == NO_FAULTS | {"counter invalid": 1}


def test_a_flipped_bit_is_a_wrong_checksum() -> None:
    frames = counting(0, 1, 2)
    frames[1].data[5] ^= 0x10
    # The refused frame is also one that the counter of the next one misses.
    assert faults_of(frames) == NO_FAULTS | {"checksum": 1, "counter skipped": 1}


def test_a_short_frame_is_a_wrong_length() -> None:
    frames = counting(0, 1)
    short = frame("B2V_ST2")
    short.data = short.data[:7]
    assert faults_of([*frames, short], "B2V_ST2") == NO_FAULTS | {"length": 1}
    assert faults_of([*frames, short]) == NO_FAULTS


def test_a_counter_at_its_wrap_is_no_fault_and_one_of_8_bits_wraps_at_256() -> None:
    frames = [frame("BSU_BMS_0", Live=n % 256) for n in (254, 255, 256, 257)]
    assert faults_of(frames, "BSU_BMS_0") == NO_FAULTS


def test_a_message_with_a_wrong_counter_is_alive() -> None:
    receiver, supervisor = Receiver(), Supervisor(PROTOCOL, "VCU", expect=[B2V_ST1])
    supervisor.start(0.0)
    for n in range(20):
        taken = receiver.take(frame("B2V_ST1", ALIV=7))
        assert isinstance(taken, Received)
        supervisor.take(taken, n * 0.1)
        supervisor.check(n * 0.1)
    assert supervisor.state(B2V_ST1) is State.ALIVE


def test_a_counter_alone_changes_no_signal() -> None:
    receiver, supervisor = Receiver(), Supervisor(PROTOCOL, "VCU")
    alarm = {"Flt_OverTemp": 2}
    events: list[SupervisionEvent] = []
    for n in (0, 1, 15, 2):
        taken = receiver.take(frame("B2V_ST1", ALIV=n, **alarm))
        assert isinstance(taken, Received)
        events += supervisor.take(taken, n * 0.1)
    assert [str(event) for event in events] == [
        "B2V_ST1: never seen -> alive",
        "B2V_ST1.flt_over_temp: alarm: Level 2-More severe fault",
    ]
