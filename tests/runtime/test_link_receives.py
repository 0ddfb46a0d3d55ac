"""`Link.receive` and iteration: what arrives is made by hand, on a bare python-can bus."""

from __future__ import annotations

import threading
import time

import can
import pytest
from can.interfaces.virtual import VirtualBus
from runtime.frames import FOREIGN, ST2, frame, st1

from swapcan import (
    Counts,
    Fault,
    Link,
    Message,
    ReceiveTimeoutError,
    SignalState,
    UnknownMessageError,
)
from swapcan.messages import B2V_ST1, B2V_ST2


class OtherMessage(Message):
    """A message of a protocol that this is not."""

    NAME = "Other"
    FRAME_ID = 0x1234


def test_a_frame_is_received_as_a_message_with_its_frame(near: can.BusABC, far: can.BusABC) -> None:
    far.send(frame(0x1882D0F3, ST2))
    received = Link(near).receive()
    message = received.message
    assert isinstance(message, B2V_ST2)
    assert message.soc == pytest.approx(80.0)
    assert message.soh is SignalState.INVALID
    assert message.current == pytest.approx(-120.5)
    assert received.frame.data == ST2
    assert received.faults == ()


def test_of_a_class_that_is_asked_for_the_next_one_is_taken_and_others_are_skipped(
    near: can.BusABC, far: can.BusABC
) -> None:
    faults: list[Fault] = []
    link = Link(near, on_fault=faults.append)
    for each in (st1(0), frame(0x1882D0F3, b""), st1(2), frame(0x1882D0F3, ST2), st1(3)):
        far.send(each)
    assert link.receive(B2V_ST2).message.soc == pytest.approx(80.0)
    assert [fault.kind for fault in faults] == ["length", "counter"]
    assert link.counts == Counts(received=3, length=1, counter=1)
    assert link.receive(B2V_ST1).message.aliv == 3
    with pytest.raises(ReceiveTimeoutError):
        link.receive(B2V_ST1, timeout=0)


def test_of_a_class_of_another_protocol_none_is_waited_for(near: can.BusABC) -> None:
    for other in (OtherMessage, Message, int):
        with pytest.raises(UnknownMessageError, match=r"is no message class of caamtb-swap$"):
            Link(near).receive(other, timeout=None)  # type: ignore[type-var]


@pytest.mark.parametrize("foreign", FOREIGN.values(), ids=FOREIGN)
def test_a_foreign_frame_is_skipped_and_counted(
    near: can.BusABC, far: can.BusABC, foreign: can.Message
) -> None:
    faults: list[Fault] = []
    link = Link(near, on_fault=faults.append)
    far.send(foreign)
    far.send(frame(0x1882D0F3, ST2))
    assert isinstance(link.receive().message, B2V_ST2)
    assert link.counts == Counts(received=1, foreign=1)
    assert faults == []


@pytest.mark.parametrize("length", [0, 7, 9])
def test_a_frame_of_another_length_is_reported_and_not_returned(
    near: can.BusABC, far: can.BusABC, length: int
) -> None:
    faults: list[Fault] = []
    link = Link(near, on_fault=faults.append)
    far.send(frame(0x1882D0F3, bytes(length), is_fd=length > 8))
    with pytest.raises(ReceiveTimeoutError):
        link.receive(timeout=0)
    (fault,) = faults
    assert (fault.kind, fault.message) == ("length", "B2V_ST2")
    assert str(fault) == f"B2V_ST2: {length} bytes instead of 8"
    assert fault.frame.data == bytes(length)
    assert link.counts == Counts(length=1)


def test_a_frame_with_a_wrong_checksum_is_reported_and_not_returned(
    near: can.BusABC, far: can.BusABC
) -> None:
    faults: list[Fault] = []
    link = Link(near, on_fault=faults.append)
    far.send(frame(0x1881D0F3, bytes.fromhex("0029400000000000")))
    with pytest.raises(ReceiveTimeoutError):
        link.receive(timeout=0)
    (fault,) = faults
    assert (fault.kind, fault.message) == ("checksum", "B2V_ST1")
    assert fault.text == "checksum is 0x00, the bytes make 0x69"
    assert link.counts == Counts(checksum=1)


def test_counts_are_a_snapshot(near: can.BusABC, far: can.BusABC) -> None:
    link = Link(near)
    before = link.counts
    far.send(frame(0x1882D0F3, ST2))
    link.receive()
    assert (before, link.counts) == (Counts(), Counts(received=1))


def test_a_silent_bus_ends_in_a_timeout_that_says_how_long(near: can.BusABC) -> None:
    start = time.monotonic()
    with pytest.raises(ReceiveTimeoutError, match=r"^no message within 0\.05 s$") as late:
        Link(near).receive(timeout=0.05)
    assert 0.05 <= time.monotonic() - start < 5
    assert isinstance(late.value, TimeoutError)
    assert late.value.timeout == 0.05


class BabblingBus(VirtualBus):
    """A bus with a frame whenever it is asked."""

    frame: can.Message

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        return self.frame, False


@pytest.mark.parametrize(
    ("babble", "count"), [(frame(0x18FEF100, ST2), "foreign"), (frame(0x1882D0F3, b""), "length")]
)
def test_a_bus_full_of_other_frames_ends_in_a_timeout_too(
    channel: str, babble: can.Message, count: str
) -> None:
    with BabblingBus(channel) as bus:
        bus.frame = babble
        link = Link(bus)
        start = time.monotonic()
        with pytest.raises(ReceiveTimeoutError):
            link.receive(timeout=0.1)
        assert 0.1 <= time.monotonic() - start < 5
        assert getattr(link.counts, count) > 100
        assert link.counts.received == 0


def test_without_waiting_a_message_behind_foreign_frames_is_found(
    near: can.BusABC, far: can.BusABC
) -> None:
    for each in (*FOREIGN.values(), frame(0x1882D0F3, ST2)):
        far.send(each)
    link = Link(near)
    assert isinstance(link.receive(timeout=0).message, B2V_ST2)
    with pytest.raises(ReceiveTimeoutError):
        link.receive(timeout=0)


def test_waiting_for_ever_ends_when_a_message_comes(near: can.BusABC, far: can.BusABC) -> None:
    link = Link(near)
    received: list[object] = []
    thread = threading.Thread(target=lambda: received.append(link.receive(timeout=None).message))
    thread.start()
    far.send(FOREIGN["a_remote_frame"])
    far.send(frame(0x1882D0F3, ST2))
    thread.join(5.0)
    assert isinstance(received[0], B2V_ST2)


def test_iteration_gives_messages_until_the_consumer_stops(
    near: can.BusABC, far: can.BusABC
) -> None:
    for each in (st1(0), FOREIGN["an_error_frame"], st1(2), st1(3)):
        far.send(each)
    counters = []
    for received in Link(near):
        assert isinstance(received.message, B2V_ST1)
        counters.append((received.message.aliv, len(received.faults)))
        if len(counters) == 3:
            break
    assert counters == [(0, 0), (2, 1), (3, 0)]
    far.send(st1(4))
    assert near.recv(1.0) is not None, "the bus stays open"


def test_iteration_ends_when_the_bus_is_shut_down(near: can.BusABC, far: can.BusABC) -> None:
    far.send(st1(0))
    count = 0
    for _ in Link(near):
        count += 1
        near.shutdown()
    assert count == 1


def test_iteration_that_waits_ends_when_the_bus_is_shut_down(
    near: can.BusABC, far: can.BusABC
) -> None:
    seen = threading.Event()

    def consume() -> None:
        for _ in Link(near):
            seen.set()

    thread = threading.Thread(target=consume)
    thread.start()
    far.send(st1(0))
    assert seen.wait(5.0)
    near.shutdown()
    thread.join(5.0)
    assert not thread.is_alive()


class QuietBus(VirtualBus):
    """A bus that does not say so when it is shut down: it only has nothing more."""

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        return (None, False) if self._is_shutdown else super()._recv_internal(timeout)


def test_iteration_ends_where_a_bus_falls_silent_when_it_is_shut_down(
    channel: str, far: can.BusABC
) -> None:
    with QuietBus(channel) as bus:
        far.send(st1(0))
        count = 0
        for _ in Link(bus):
            count += 1
            bus.shutdown()
    assert count == 1


class BrokenBus(VirtualBus):
    """A bus whose adapter was pulled out."""

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        raise can.CanOperationError("adapter is gone")


def test_an_error_of_the_bus_passes_through(channel: str) -> None:
    with BrokenBus(channel) as bus:
        with pytest.raises(can.CanOperationError, match="adapter is gone"):
            Link(bus).receive()
        with pytest.raises(can.CanOperationError, match="adapter is gone"):
            next(iter(Link(bus)))


def test_a_link_neither_configures_nor_closes_its_bus(near: can.BusABC, far: can.BusABC) -> None:
    near.set_filters([{"can_id": 0x1881D0F3, "can_mask": 0x1FFFFFFF, "extended": True}])
    link = Link(near)
    far.send(frame(0x1882D0F3, ST2))
    far.send(st1(0))
    assert isinstance(link.receive().message, B2V_ST1)
    assert near.filters is not None
    del link
    far.send(st1(1))
    assert near.recv(1.0) is not None
