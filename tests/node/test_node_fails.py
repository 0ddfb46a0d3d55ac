"""A node of which a thread cannot go on ends what acts, says so, and sends no more."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Callable, Iterator

import can
import pytest
from node.bench import Recorder
from node.rough_bus import (
    ENDS,
    RoughBus,
    frames_until,
    is_off,
    is_on,
    raising,
    rest,
    signals,
    trailing_offs,
)
from node.test_bus_timers import TimerBus

from swapcan import Codec, StillActingError
from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import (
    B2V_ST2,
    BMS_TMS_0,
    V2B_CMD,
    V2B_VIN,
    B2C_Charger,
    ChargeControl,
    HvCommand,
    HvRequest,
    V2B_RQData,
)
from swapcan.node import Event, Node, NodeFailed, SendingError
from typedcan.node.errors import RequestError

ON = V2B_CMD(hv_on_off=HvCommand.HV_ON)
CHARGE = B2C_Charger(charge_control=ChargeControl.START_TO_CHARGE)

Make = Callable[[], BaseException]

all_ends = pytest.mark.parametrize("error", ENDS.values(), ids=ENDS)

pytestmark = pytest.mark.usefixtures("hurried_leaving")


def st2() -> can.Message:
    return can.Message(arbitration_id=B2V_ST2.FRAME_ID, data=bytes(8))


def threads_of(name: str) -> list[threading.Thread]:
    return [each for each in threading.enumerate() if each.name.startswith(f"typedcan-{name}")]


def assert_has_ended(node: Node, failed: Recorder, error: Make) -> None:
    """The node says so, has no thread, and takes nothing to send any more."""
    (event,) = failed.wait(timeout=30.0)
    shown = str(error()) or type(error()).__name__
    assert shown in event.error
    for thread in threads_of(node.name):
        thread.join(30.0)
        assert not thread.is_alive()
    own, other = (ON, V2B_VIN) if node.name == "VCU" else (CHARGE, B2V_ST2)
    refused: list[Callable[[], object]] = [
        lambda: node.set(own),
        lambda: node.send(own),
        lambda: node.supply(type(own), lambda: [own]),
        lambda: node.provide(other()),
        lambda: node.provide_from(other, lambda: [other()]),
        node.request_battery_info if node.name == "VCU" else node.request_vin,
    ]
    for act in refused:
        with pytest.raises(SendingError) as raised:
            act()
        assert f"{node.name} sends nothing more" in str(raised.value)
        assert shown in str(raised.value)


@pytest.fixture
def failed() -> Recorder:
    return Recorder()


@pytest.fixture
def vcu(rough: RoughBus, failed: Recorder) -> Iterator[Node]:
    node = Node(PROTOCOL, "VCU", rough)
    node.on(NodeFailed, failed)
    node.start()
    node.set(ON)
    yield node
    rough.before_send = rough.before_recv = raising(RuntimeError, times=0)
    node.stop()


@all_ends
def test_recv_ends_it(
    rough: RoughBus, far: can.BusABC, vcu: Node, failed: Recorder, error: Make
) -> None:
    heard = frames_until(far, is_on)
    rough.before_recv = raising(error)
    assert_has_ended(vcu, failed, error)
    assert len(trailing_offs(heard + rest(far))) >= 5
    start = time.perf_counter()
    vcu.stop()
    assert time.perf_counter() - start < 1.0
    assert rest(far) == []


@all_ends
def test_send_ends_it_where_it_fails_once(
    rough: RoughBus, far: can.BusABC, vcu: Node, failed: Recorder, error: Make
) -> None:
    heard = frames_until(far, is_on)
    rough.before_send = raising(error, times=1)
    assert_has_ended(vcu, failed, error)
    assert len(trailing_offs(heard + rest(far))) >= 5
    vcu.stop()
    assert rest(far) == []


@all_ends
def test_send_ends_it_where_it_fails_for_good_and_what_is_live_is_said(
    rough: RoughBus, far: can.BusABC, vcu: Node, failed: Recorder, error: Make
) -> None:
    frames_until(far, is_on)
    rough.before_send = raising(error)
    tried = rough.tried_to_send
    assert_has_ended(vcu, failed, error)
    assert rough.tried_to_send >= tried + 5
    with pytest.raises(StillActingError) as raised:
        vcu.stop()
    assert raised.value.messages == ("V2B_CMD",)
    assert (str(error()) or type(error()).__name__) in raised.value.cause
    assert threads_of("VCU") == []


@all_ends
def test_what_makes_a_message_ends_it(
    far: can.BusABC, vcu: Node, failed: Recorder, error: Make
) -> None:
    heard = frames_until(far, is_on)
    act = raising(error)
    vcu.supply(V2B_VIN, lambda: act() or [], period=0.01)
    assert_has_ended(vcu, failed, error)
    assert len(trailing_offs(heard + rest(far))) >= 5


@all_ends
def test_a_callback_ends_it_and_the_others_are_called_first(
    far: can.BusABC, vcu: Node, failed: Recorder, error: Make
) -> None:
    other = Recorder()
    vcu.on(B2V_ST2, raising(error))
    vcu.on(B2V_ST2, other)
    heard = frames_until(far, is_on)
    far.send(st2())
    assert_has_ended(vcu, failed, error)
    assert len(other.seen) == 1
    assert len(trailing_offs(heard + rest(far))) >= 5


@all_ends
def test_opening_another_bus_ends_it(
    rough: RoughBus, far: can.BusABC, failed: Recorder, error: Make
) -> None:
    act = raising(error)
    node = Node(PROTOCOL, "VCU", rough, reopen=lambda: act() or rough)
    node.on(NodeFailed, failed)
    with node:
        node.set(ON)
        heard = frames_until(far, is_on)
        rough.before_recv = raising(OSError)
        assert_has_ended(node, failed, error)
    assert len(trailing_offs(heard + rest(far))) >= 5


@all_ends
@pytest.mark.parametrize("direction", ["send", "receive"])
def test_a_checksum_ends_it(
    near: can.BusABC, far: can.BusABC, failed: Recorder, error: Make, direction: str
) -> None:
    act = raising(error, times=1)
    codec = Codec(algorithms={"BMS_CRC": lambda data: act() or 0})
    with Node(PROTOCOL, "BMU" if direction == "send" else "TMS", near, codec=codec) as node:
        node.on(NodeFailed, failed)
        if direction == "send":
            node.set(CHARGE, period=0.01)
            frames_until(far, lambda frame: signals(frame)["B2V_S_ChargeControl"] == 0)
            request = BMS_TMS_0(reqst_tms_hv_on=HvRequest.REQUEST_HV_ON)
            node.supply(BMS_TMS_0, lambda: [request], period=0.01)
            assert_has_ended(node, failed, error)
            last = rest(far)[-1]
            assert signals(last)["B2V_S_ChargeControl"] == 1
        else:
            far.send(can.Message(arbitration_id=BMS_TMS_0.FRAME_ID, data=bytes(8)))
            failed.wait()
            with pytest.raises(SendingError, match="TMS sends nothing more"):
                node.set(next(iter(PROTOCOL.sent_by("TMS")))())


def test_one_who_is_told_may_raise_too_and_stop_the_node(
    rough: RoughBus, far: can.BusABC, vcu: Node, failed: Recorder
) -> None:
    stopped = Recorder()
    vcu.on(NodeFailed, raising(lambda: SystemExit(1)))

    def stop(event: NodeFailed) -> None:
        vcu.stop()
        stopped(event)

    vcu.on(NodeFailed, stop)
    heard = frames_until(far, is_on)
    rough.before_send = raising(lambda: SystemExit(3), times=1)
    stopped.wait(timeout=30.0)
    assert_has_ended(vcu, failed, lambda: SystemExit(3))
    assert is_off((heard + rest(far))[-1])


def test_a_stream_tells_it_and_a_request_under_way_ends(rough: RoughBus, far: can.BusABC) -> None:
    async def scenario() -> list[Event]:
        seen: list[Event] = []
        async with Node(PROTOCOL, "VCU", rough) as node:
            events = node.events()
            pending = node.request_battery_info(timeout=1000.0)
            rough.before_recv = raising(lambda: SystemExit("out of memory"))
            async for event in events:
                seen.append(event)
                if isinstance(event, NodeFailed):
                    break
            await events.aclose()
            with pytest.raises(RequestError):
                await pending
        return seen

    seen = asyncio.run(asyncio.wait_for(scenario(), 30.0))
    assert isinstance(seen[-1], NodeFailed)
    assert "SystemExit: out of memory" in str(seen[-1])
    asked = [frame for frame in rest(far) if frame.arbitration_id == V2B_RQData.FRAME_ID]
    assert len(asked) <= 1  # it is not even withdrawn: nothing more is sent


def test_a_node_that_failed_can_be_started_again(
    rough: RoughBus, far: can.BusABC, vcu: Node, failed: Recorder
) -> None:
    rough.before_recv = raising(lambda: SystemExit(3), times=1)
    failed.wait(timeout=30.0)
    vcu.stop()
    rest(far)
    with vcu:
        vcu.set(ON)
        assert is_on(frames_until(far, is_on)[-1])
    assert is_off(rest(far)[-1])


def test_what_the_interface_repeats_is_taken_back(near: can.BusABC, failed: Recorder) -> None:
    near.__class__ = TimerBus
    assert isinstance(near, TimerBus)
    near.noted = Recorder()
    with Node(PROTOCOL, "BMU", near) as node:
        node.on(NodeFailed, failed)
        node.set(B2V_ST2())
        near.noted.wait_until(lambda noted: noted[0] == "begin")
        node.supply(BMS_TMS_0, raising(lambda: SystemExit(3)), period=0.01)
        near.noted.wait_until(lambda noted: noted[0] == "end")
        failed.wait()


def test_where_no_second_thread_can_be_started_none_is_left(
    near: can.BusABC, far: can.BusABC, monkeypatch: pytest.MonkeyPatch
) -> None:
    started: list[threading.Thread] = []
    start = threading.Thread.start

    def start_one(thread: threading.Thread) -> None:
        if started:
            raise RuntimeError("can't start new thread")
        started.append(thread)
        start(thread)

    node = Node(PROTOCOL, "VCU", near)
    node.set(ON)
    monkeypatch.setattr(threading.Thread, "start", start_one)
    with pytest.raises(RuntimeError, match="can't start"):
        node.start()
    monkeypatch.undo()
    assert not started[0].is_alive()
    frames = rest(far)
    assert frames == [] or is_off(frames[-1])
    with node:
        node.set(ON)
        frames_until(far, is_on)
    assert is_off(rest(far)[-1])
