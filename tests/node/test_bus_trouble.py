"""A bus that goes away and comes back, seen from a node."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from itertools import pairwise

import can
import pytest
from can.interfaces.virtual import VirtualBus
from node.bench import Bench, Recorder, frames_on

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import B2V_ST1, B2V_ST2, B2V_ST3
from swapcan.node import Node
from typedcan.node.events import BusBack, BusLost, SendFailed


class LooseBus(VirtualBus):
    """A bus whose adapter can be pulled out and put back; it counts how often it is tried."""

    broken: Exception | None = None
    tried = 0

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        self.tried += 1
        if self.broken:
            raise self.broken
        return super()._recv_internal(timeout)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        if self.broken:
            raise self.broken
        super().send(msg, timeout)


@pytest.fixture
def loose(far: can.BusABC) -> LooseBus:
    assert isinstance(far, VirtualBus)
    far.__class__ = LooseBus  # on the channel of the test, and closed after it
    assert isinstance(far, LooseBus)
    return far


def st2() -> can.Message:
    return can.Message(arbitration_id=B2V_ST2.FRAME_ID, data=bytes(8))


@pytest.mark.parametrize(
    "error",
    [
        can.CanOperationError("adapter is gone"),
        OSError(100, "Network is down"),
        ValueError("file descriptor cannot be a negative integer (-1)"),
        can.CanTimeoutError(),
    ],
)
def test_a_bus_is_reported_lost_once_and_back_once(
    near: can.BusABC, loose: LooseBus, error: Exception
) -> None:
    lost, back, heard = Recorder(), Recorder(), Recorder()
    with Node(PROTOCOL, "VCU", loose) as node:
        node.on(BusLost, lost)
        node.on(BusBack, back)
        node.on(B2V_ST2, heard)
        loose.broken = error
        lost.wait()
        tried = loose.tried
        while loose.tried < tried + 2:
            threading.Event().wait(0.01)
        assert back.seen == []
        loose.broken = None
        back.wait()
        near.send(st2())
        heard.wait()
    (event,) = lost.seen
    assert event.error == (str(error) or "CanTimeoutError")
    assert len(back.seen) == 1


def test_waiting_for_a_lost_bus_costs_next_to_nothing(loose: LooseBus) -> None:
    lost = Recorder()
    with Node(PROTOCOL, "VCU", loose) as node:
        node.on(BusLost, lost)
        loose.broken = OSError("down")
        lost.wait()
        before = time.process_time()
        threading.Event().wait(0.5)
        assert time.process_time() - before < 0.1


def test_it_is_tried_again_less_and_less_often_up_to_every_two_seconds(loose: LooseBus) -> None:
    bench = Bench()
    bench.node("VCU", loose)
    loose.broken = OSError("down")
    tries = []
    while bench.clock.now() < 12.0:
        before = loose.tried
        bench.run(round(bench.clock.now() + 0.01, 2))
        if loose.tried > before:
            tries.append(bench.clock.now())
    # 0.05 s, then twice as long each time, and never more than 2 s
    gaps = [b - a for a, b in pairwise(tries)]
    assert gaps == pytest.approx([0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 2.0, 2.0, 2.0, 2.0], abs=0.025)


def test_the_back_off_begins_anew_after_the_bus_was_back(loose: LooseBus) -> None:
    bench = Bench()
    node = bench.node("VCU", loose)
    for _ in range(2):
        loose.broken = OSError("down")
        bench.run(bench.clock.now() + 3.0)
        loose.broken = None
        bench.run(bench.clock.now() + 3.0)
    loose.broken = OSError("down")
    node.turn()
    assert node.next_due == pytest.approx(bench.clock.now() + 0.05)


def test_supervision_goes_on_while_the_bus_is_lost(near: can.BusABC, loose: LooseBus) -> None:
    bench = Bench()
    node = bench.node("VCU", loose)
    near.send(st2())
    bench.run(0.01)
    assert node.state(B2V_ST2).name == "ALIVE"
    loose.broken = OSError("down")
    bench.run(0.16 + 0.01)
    assert node.state(B2V_ST2).name == "LATE"
    bench.run(0.6)
    assert node.state(B2V_ST2).name == "LOST"


def test_sending_goes_on_and_each_message_is_reported_once(
    near: can.BusABC, loose: LooseBus
) -> None:
    bench, failed, lost, back = Bench(), Recorder(), Recorder(), Recorder()
    node = bench.node("BMU", loose)
    for kind, recorder in ((SendFailed, failed), (BusLost, lost), (BusBack, back)):
        node.on(kind, recorder)
    node.set(B2V_ST1(), B2V_ST2())
    bench.run(0.25)
    sent = [
        frame.data[1] & 0x0F
        for frame in frames_on(near)
        if frame.arbitration_id == B2V_ST1.FRAME_ID
    ]
    loose.broken = can.CanOperationError("bus off")
    bench.run(2.25)
    assert frames_on(near) == []
    assert {event.message for event in failed.seen} == {B2V_ST1, B2V_ST2}
    assert len(failed.seen) == 2
    assert {event.error for event in failed.seen} == {"bus off"}
    assert (len(lost.seen), len(back.seen)) == (1, 0)
    loose.broken = None
    bench.run(4.25)
    assert (len(lost.seen), len(back.seen)) == (1, 1)
    again = [
        frame.data[1] & 0x0F
        for frame in frames_on(near)
        if frame.arbitration_id == B2V_ST1.FRAME_ID
    ]
    # The counter goes on where the bus accepted the last frame.
    assert [*sent, *again][:8] == list(range(8))
    assert len(failed.seen) == 2
    loose.broken = can.CanOperationError("bus off")
    bench.run(4.5)
    assert len(failed.seen) == 4


def test_a_full_queue_holds_nothing_up(open_bus: Callable[..., can.BusABC]) -> None:
    near = open_bus()
    narrow = open_bus(rx_queue_size=1)
    failed = Recorder()
    with Node(PROTOCOL, "BMU", near) as node:
        node.on(SendFailed, failed)
        node.set(B2V_ST1(), B2V_ST2(), B2V_ST3(), period=0.01)
        failed.wait(2)
        assert narrow.recv(0)


def test_another_bus_is_opened_in_place_of_one_that_was_closed(
    open_bus: Callable[..., can.BusABC], near: can.BusABC
) -> None:
    lent = open_bus()
    opened: list[can.BusABC] = []

    def reopen() -> can.BusABC:
        opened.append(open_bus())
        return opened[-1]

    lost, back, heard, failed = Recorder(), Recorder(), Recorder(), Recorder()
    with Node(PROTOCOL, "VCU", lent, reopen=reopen) as node:
        for kind, recorder in ((BusLost, lost), (BusBack, back), (SendFailed, failed)):
            node.on(kind, recorder)
        node.on(B2V_ST2, heard)
        lent.shutdown()
        back.wait()
        near.send(st2())
        heard.wait()
        opened[0].shutdown()
        back.wait(2)
        near.send(st2())
        heard.wait(2)
    assert len(opened) == 2
    with pytest.raises(can.CanOperationError) as closed:
        opened[1].send(st2())  # the node closed what it had opened
    assert [event.error for event in lost.seen] == [str(closed.value)] * 2


def test_opening_is_tried_again_where_it_fails(
    open_bus: Callable[..., can.BusABC], near: can.BusABC
) -> None:
    bench, back, heard = Bench(), Recorder(), Recorder()
    lent = open_bus()
    tries = 0

    def reopen() -> can.BusABC:
        nonlocal tries
        tries += 1
        if tries < 3:
            raise can.CanInitializationError("no such device")
        return open_bus()

    node = bench.node("VCU", lent, reopen=reopen)
    node.on(BusBack, back)
    node.on(B2V_ST2, heard)
    lent.shutdown()
    bench.run(1.0)
    assert (tries, len(back.seen)) == (3, 1)
    near.send(st2())
    bench.run(1.1)
    assert len(heard.seen) == 1


def test_a_lent_bus_that_is_not_lost_stays_open(near: can.BusABC, far: can.BusABC) -> None:
    with Node(PROTOCOL, "VCU", near, reopen=lambda: pytest.fail("opened")):
        pass
    near.send(st2())
    assert far.recv(0)
