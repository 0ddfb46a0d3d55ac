"""Nodes in threads: what they start they end, and nothing else."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Callable

import can
import pytest
from can.broadcastmanager import ThreadBasedCyclicSendTask
from node.bench import Bench, Recorder, at_rest

from swapcan import Received
from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import B2V_RQ, B2V_ST1, B2V_ST2, V2B_CMD
from swapcan.node import Node
from typedcan.model.errors import TypedcanError
from typedcan.supervise import NotSeen, State, StateChanged


def test_two_nodes_hear_each_other(near: can.BusABC, far: can.BusABC) -> None:
    heard = Recorder()
    with Node(PROTOCOL, "BMU", near) as bmu, Node(PROTOCOL, "VCU", far) as vcu:
        vcu.on(B2V_ST2, heard)
        bmu.set(B2V_ST2(soc=80.0))
        first, second = heard.wait(2)
        assert (first.message.soc, second.message.soc) == (80.0, 80.0)
        assert vcu.state(B2V_ST2) is State.ALIVE
        last = vcu.last(B2V_ST2)
        assert last is not None
        assert last.message == B2V_ST2(soc=80.0)
        assert vcu.last(B2V_ST1) is None
        assert vcu.counts.received >= 2


def test_a_node_has_two_threads_whatever_it_sends(near: can.BusABC) -> None:
    before = threading.active_count()
    with Node(PROTOCOL, "BMU", near) as node:
        node.set(*map(at_rest, PROTOCOL.sent_by("BMU")))
        assert threading.active_count() == before + 2


def test_leaving_takes_less_than_a_fifth_of_a_second(near: can.BusABC) -> None:
    node = Node(PROTOCOL, "BMU", near)
    with node:
        node.set(B2V_ST2())
        start = time.perf_counter()
    assert time.perf_counter() - start < 0.2


def test_leaving_ends_what_the_node_began_and_nothing_else(
    near: can.BusABC, far: can.BusABC
) -> None:
    theirs = can.Message(arbitration_id=0x123, is_extended_id=False)
    task = near.send_periodic(theirs, 0.01)
    with Node(PROTOCOL, "BMU", near) as node:
        node.set(B2V_ST2(), period=0.01)
        while (frame := far.recv(1.0)) and frame.arbitration_id != B2V_ST2.FRAME_ID:
            pass
        assert frame
    while far.recv(0):
        pass
    later = [far.recv(1.0) for _ in range(5)]
    assert {frame.arbitration_id for frame in later if frame} == {0x123}
    task.stop()
    assert isinstance(task, ThreadBasedCyclicSendTask)
    assert task.thread
    task.thread.join()
    near.send(theirs)  # the bus is open


def test_stopping_twice_or_before_starting_does_nothing(near: can.BusABC) -> None:
    node = Node(PROTOCOL, "BMU", near)
    node.stop()
    node.start()
    node.stop()
    node.stop()


def test_a_node_can_be_started_again(near: can.BusABC, far: can.BusABC) -> None:
    node = Node(PROTOCOL, "BMU", near)
    node.set(B2V_ST1(), period=0.01)
    counters = []
    for _ in range(2):
        with node:
            for _ in range(3):
                frame = far.recv(1.0)
                assert frame
                counters.append(frame.data[1] & 0x0F)
        while frame := far.recv(0):
            counters.append(frame.data[1] & 0x0F)
    assert counters == [number % 15 for number in range(len(counters))]


def test_a_started_node_is_neither_started_nor_turned(near: can.BusABC) -> None:
    with Node(PROTOCOL, "BMU", near) as node:
        with pytest.raises(TypedcanError, match="started already"):
            node.start()
        with pytest.raises(TypedcanError, match="its threads turn it"):
            node.turn()


def test_what_is_set_before_the_start_goes_out_after_it(near: can.BusABC, far: can.BusABC) -> None:
    node = Node(PROTOCOL, "BMU", near)
    node.set(B2V_RQ(), B2V_ST2())
    assert far.recv(0) is None
    with node:
        frames = [far.recv(1.0), far.recv(1.0)]
    identifiers = [frame.arbitration_id for frame in frames if frame]
    assert identifiers == [B2V_RQ.FRAME_ID, B2V_ST2.FRAME_ID]


def test_async_with_starts_and_ends_a_node(near: can.BusABC, far: can.BusABC) -> None:
    async def scenario() -> bool:
        before = threading.active_count()
        async with Node(PROTOCOL, "BMU", near) as node:
            node.set(B2V_ST2())
            assert threading.active_count() == before + 2
            assert await asyncio.to_thread(far.recv, 1.0)
        return threading.active_count() <= before + 1  # to_thread keeps its own

    assert asyncio.run(scenario())


def test_leaving_does_not_hold_up_the_event_loop(near: can.BusABC) -> None:
    async def scenario() -> float:
        longest = 0.0

        async def tick() -> None:
            nonlocal longest
            while True:
                start = time.perf_counter()
                await asyncio.sleep(0.001)
                longest = max(longest, time.perf_counter() - start)

        ticking = asyncio.create_task(tick())
        async with Node(PROTOCOL, "BMU", near):
            await asyncio.sleep(0.01)
        ticking.cancel()
        return longest

    assert asyncio.run(scenario()) < 0.08  # a receiver waits up to 0.1 s


def test_a_callback_that_raises_is_logged_and_stops_nothing(
    near: can.BusABC, far: can.BusABC, caplog: pytest.LogCaptureFixture
) -> None:
    def fail(received: Received[B2V_ST2]) -> None:
        raise ZeroDivisionError

    heard = Recorder()
    with Node(PROTOCOL, "BMU", near) as bmu, Node(PROTOCOL, "VCU", far) as vcu:
        vcu.on(B2V_ST2, fail)
        vcu.on(B2V_ST2, heard)
        bmu.set(B2V_ST2(), period=0.01)
        heard.wait(2)
    record = caplog.records[0]
    assert (record.name, record.levelname) == ("typedcan", "ERROR")
    assert record.exc_info
    assert record.exc_info[0] is ZeroDivisionError


def test_a_callback_can_stop_its_node(near: can.BusABC, far: can.BusABC) -> None:
    node = Node(PROTOCOL, "VCU", far)
    stopped = threading.Event()

    def stop(received: Received[B2V_ST2]) -> None:
        node.stop()
        stopped.set()

    node.on(B2V_ST2, stop)
    node.start()
    threads = [thread for thread in threading.enumerate() if thread.name.startswith("typedcan-VCU")]
    near.send(can.Message(arbitration_id=B2V_ST2.FRAME_ID, data=bytes(8)))
    assert stopped.wait(2.0)
    node.start()  # perhaps before the old thread has left the callback
    for thread in threads:
        thread.join(2.0)
        assert not thread.is_alive()
    assert len(threads) == 2
    node.stop()


def test_a_callback_that_is_taken_off_is_called_no_more(near: can.BusABC, far: can.BusABC) -> None:
    bench, kept, gone = Bench(), Recorder(), Recorder()
    vcu = bench.node("VCU", far)
    vcu.on(B2V_ST2, kept)
    take_off = vcu.on(B2V_ST2, gone)
    frame = can.Message(arbitration_id=B2V_ST2.FRAME_ID, data=bytes(8))
    near.send(frame)
    vcu.turn()
    take_off()
    take_off()
    near.send(frame)
    vcu.turn()
    assert (len(kept.seen), len(gone.seen)) == (2, 1)


def test_an_expected_message_is_missed_and_lost_on_time(near: can.BusABC, far: can.BusABC) -> None:
    changed, missed = Recorder(), Recorder()
    with Node(PROTOCOL, "VCU", far, expect=[B2V_ST2, B2V_ST1], timeouts={B2V_ST1: 0.3}) as vcu:
        vcu.on(StateChanged, changed)
        vcu.on(NotSeen, missed)
        with Node(PROTOCOL, "BMU", near) as bmu:
            bmu.set(B2V_ST2(), period=0.1)
            changed.wait_until(lambda event: event.new is State.ALIVE)
        lost = changed.wait_until(lambda event: event.new is State.LOST)
        assert lost.message is B2V_ST2
        assert lost.silence == pytest.approx(0.5, abs=0.15)  # five periods of 0.1 s
        assert missed.wait()[0].message is B2V_ST1
        snapshot = {each.name: each.state for each in vcu.snapshot().messages}
        assert snapshot["B2V_ST2"] is State.LOST


def test_the_commands_of_a_callback_go_out(near: can.BusABC, far: can.BusABC) -> None:
    def follow(received: Received[B2V_ST2]) -> None:
        assert isinstance(received.message.soc, float)
        vcu.set(V2B_CMD(vehicle_speed=received.message.soc))

    heard = Recorder()
    with Node(PROTOCOL, "BMU", near) as bmu, Node(PROTOCOL, "VCU", far) as vcu:
        vcu.on(B2V_ST2, follow)
        bmu.on(V2B_CMD, heard)
        bmu.set(B2V_ST2(soc=42.0))
        assert heard.wait()[0].message.vehicle_speed == 42.0


def test_frames_of_all_kinds_of_faults_stop_nothing(
    open_bus: Callable[..., can.BusABC], near: can.BusABC, far: can.BusABC
) -> None:
    heard = Recorder()
    with Node(PROTOCOL, "VCU", far) as vcu:
        vcu.on(B2V_ST2, heard)
        near.send(can.Message(arbitration_id=B2V_ST1.FRAME_ID, data=bytes(7)))
        near.send(can.Message(arbitration_id=B2V_ST1.FRAME_ID, data=bytes(7) + b"\1"))
        near.send(can.Message(arbitration_id=0x18FEF100, data=bytes(8)))
        near.send(can.Message(arbitration_id=B2V_ST2.FRAME_ID, is_error_frame=True))
        near.send(can.Message(arbitration_id=B2V_ST2.FRAME_ID, is_remote_frame=True, dlc=8))
        near.send(can.Message(arbitration_id=B2V_ST2.FRAME_ID, data=bytes(8)))
        heard.wait()
        counts = vcu.counts
    assert (counts.received, counts.length, counts.checksum, counts.foreign) == (1, 1, 1, 3)
