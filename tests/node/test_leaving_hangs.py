"""Leaving a node whose bus or maker hangs, which is interrupted, or left from within."""

from __future__ import annotations

import _thread
import asyncio
import os
import signal
import threading
import time

import can
import pytest
from node.bench import Recorder
from node.rough_bus import (
    Hang,
    RoughBus,
    commands,
    frames_until,
    is_off,
    is_on,
    nothing,
    raising,
    rest,
    signals,
    trailing_offs,
)

from swapcan import StillActingError
from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import B2V_ST2, V2B_CMD, V2B_VIN, HvCommand, V2B_RQData
from swapcan.node import Node
from typedcan.model.errors import TypedcanError
from typedcan.wire.message import Message

ON = V2B_CMD(hv_on_off=HvCommand.HV_ON)


@pytest.fixture
def short_patience(monkeypatch: pytest.MonkeyPatch) -> None:
    """For threads that hang until the test releases them."""
    monkeypatch.setattr("typedcan.node.engine._PATIENCE", 0.3)


def hang_once(rough: RoughBus, hang: Hang) -> threading.Event:
    """The next transmission hangs, those beside it do not; says when it has begun."""
    begun = threading.Event()

    def act(_: can.Message) -> None:
        rough.before_send = nothing
        begun.set()
        hang()

    rough.before_send = act
    return begun


@pytest.mark.usefixtures("short_patience")
def test_beside_a_transmission_that_hangs_the_safe_codes_go_out_and_again_after_it(
    rough: RoughBus, far: can.BusABC, hang: Hang
) -> None:
    node = Node(PROTOCOL, "VCU", rough)
    node.start()
    node.set(ON)
    frames_until(far, is_on)
    begun = hang_once(rough, hang)
    assert begun.wait(30.0)
    rest(far)
    with pytest.raises(StillActingError) as raised:  # what hangs may go out at any time
        node.stop()
    assert raised.value.messages == ("V2B_CMD",)
    assert len(trailing_offs(rest(far))) >= 5
    with pytest.raises(TypedcanError, match="still hangs"):
        node.start()
    hang.release()
    heard = frames_until(far, is_on)  # the one that hung
    heard += frames_until(far, is_off)
    assert is_off((heard + rest(far))[-1])


@pytest.mark.usefixtures("short_patience")
def test_a_bus_that_takes_nothing_while_a_transmission_hangs_holds_nothing_up(
    rough: RoughBus, far: can.BusABC, hang: Hang
) -> None:
    node = Node(PROTOCOL, "VCU", rough)
    node.start()
    node.set(ON)
    pending = node.request_pack_code(timeout=1000.0)
    frames_until(far, is_on)
    rough.before_send = hang
    start = time.perf_counter()
    with pytest.raises(StillActingError, match="TAKE IT FOR LIVE"):
        node.stop()
    assert time.perf_counter() - start < 3.0
    with pytest.raises(TypedcanError, match="stopped"):
        pending.result(0)


@pytest.mark.usefixtures("short_patience")
def test_a_maker_that_hangs_keeps_nothing_on(rough: RoughBus, far: can.BusABC, hang: Hang) -> None:
    begun = threading.Event()

    def make() -> list[Message]:
        begun.set()
        hang()
        return [V2B_VIN(frame_no=1)]

    node = Node(PROTOCOL, "VCU", rough)
    node.start()
    node.set(ON)
    heard = frames_until(far, is_on)
    node.supply(V2B_VIN, make, period=0.01)
    assert begun.wait(30.0)
    node.stop()
    assert len(trailing_offs(heard + rest(far))) >= 5
    hang.release()
    for thread in threading.enumerate():
        if thread.name == "typedcan-VCU-send":
            thread.join(30.0)
    assert rest(far) == []  # what it makes after all is not sent


@pytest.mark.usefixtures("short_patience")
def test_async_with_is_left_in_time_where_a_thread_hangs(
    rough: RoughBus, far: can.BusABC, hang: Hang
) -> None:
    async def scenario() -> float:
        async with Node(PROTOCOL, "VCU", rough) as node:
            node.set(ON)
            await asyncio.to_thread(frames_until, far, is_on)
            rough.before_recv = hang
            start = time.perf_counter()
        return time.perf_counter() - start

    assert asyncio.run(asyncio.wait_for(scenario(), 30.0)) < 10.0
    assert is_off(rest(far)[-1])


def test_a_bus_that_is_slower_than_the_periods_is_left_all_the_same(
    rough: RoughBus, far: can.BusABC
) -> None:
    rough.before_send = lambda _: time.sleep(0.02)
    with Node(PROTOCOL, "VCU", rough) as node:
        node.set(ON, period=0.01)  # something is due at any time
        heard = frames_until(far, is_on)
    assert len(trailing_offs(heard + rest(far))) >= 5


def test_a_callback_that_stops_its_node_ends_what_acts(near: can.BusABC, far: can.BusABC) -> None:
    stopped = threading.Event()
    node = Node(PROTOCOL, "VCU", near)

    def stop(_: object) -> None:
        node.stop()
        stopped.set()

    node.on(B2V_ST2, stop)
    node.start()
    node.set(ON)
    heard = frames_until(far, is_on)
    far.send(can.Message(arbitration_id=B2V_ST2.FRAME_ID, data=bytes(8)))
    assert stopped.wait(30.0)
    assert len(trailing_offs(heard + rest(far))) >= 5
    node.stop()


def test_a_maker_that_stops_its_node_ends_what_acts(
    near: can.BusABC, far: can.BusABC, open_bus: object
) -> None:
    stopped = threading.Event()
    node = Node(PROTOCOL, "VCU", near)

    def make() -> list[Message]:
        node.stop()
        stopped.set()
        return [V2B_VIN(frame_no=1)]

    node.start()
    node.set(ON)
    heard = frames_until(far, is_on)
    node.supply(V2B_VIN, make, period=0.01)
    assert stopped.wait(30.0)
    heard += rest(far)
    assert len(trailing_offs(heard)) >= 5
    with node:
        node.clear(V2B_VIN)
        assert is_on(frames_until(far, is_on)[-1])
    assert is_off(commands(rest(far))[-1])


@pytest.mark.skipif(
    signal.getsignal(signal.SIGINT) is not signal.default_int_handler,
    reason="KeyboardInterrupt is not what Ctrl-C is here",
)
def test_ctrl_c_while_a_node_is_stopped_does_not_keep_it_on(
    rough: RoughBus, far: can.BusABC
) -> None:
    node = Node(PROTOCOL, "VCU", rough)
    node.start()
    node.set(ON)
    heard = frames_until(far, is_on)

    def interrupt(frame: can.Message) -> None:
        if is_off(frame):
            rough.before_send = nothing
            _thread.interrupt_main()  # which waits for the threads now

    rough.before_send = interrupt
    with pytest.raises(KeyboardInterrupt):
        node.stop()
    for thread in threading.enumerate():
        if thread.name.startswith("typedcan-VCU"):
            thread.join(30.0)
    assert len(trailing_offs(heard + rest(far))) >= 5
    node.stop()
    assert rest(far) == []


def test_an_interrupt_at_the_first_step_of_stopping_does_not_keep_it_on(
    near: can.BusABC, far: can.BusABC, monkeypatch: pytest.MonkeyPatch
) -> None:
    node = Node(PROTOCOL, "VCU", near)
    node.start()
    node.set(ON)
    heard = frames_until(far, is_on)
    for thread in threading.enumerate():
        if thread.name.startswith("typedcan-VCU"):
            monkeypatch.setattr(thread, "join", raising(KeyboardInterrupt, times=1))
    with pytest.raises(KeyboardInterrupt):
        node.stop()
    monkeypatch.undo()
    node.stop()
    assert len(trailing_offs(heard + rest(far))) >= 5


def test_a_request_under_way_is_withdrawn_after_the_safe_codes(
    near: can.BusABC, far: can.BusABC
) -> None:
    with Node(PROTOCOL, "VCU", near) as node:
        node.set(ON)
        node.request_pack_code(timeout=1000.0)
        heard = frames_until(far, is_on)
    heard += rest(far)
    assert heard[-1].arbitration_id == V2B_RQData.FRAME_ID
    assert signals(heard[-1])["V2B_RD_RQSysCode"] == 2
    assert is_off(heard[-2])


@pytest.mark.skipif(not hasattr(os, "fork"), reason="Windows has no fork")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # of fork beside threads, since 3.12
def test_a_copy_of_the_process_does_not_speak_for_its_parent(
    near: can.BusABC, far: can.BusABC
) -> None:
    taken: Recorder = Recorder()
    with Node(PROTOCOL, "VCU", near) as node:
        node.set(ON)
        node.request_pack_code(timeout=1000.0)
        frames_until(far, is_on)
        pid = os.fork()
        if pid == 0:
            # The copy leaves the block and ends: what it sends can be counted here alone.
            near.send = taken  # type: ignore[method-assign, assignment]
            code = 1
            try:
                node.stop()
                code = len(taken.seen)
            finally:
                os._exit(code)
        assert os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == 0
        assert is_on(frames_until(far, is_on)[-1])
    assert is_off(commands(rest(far))[-1])
