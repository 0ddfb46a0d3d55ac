"""A node that has commanded something that acts ends it before it leaves, however it is left."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Callable
from itertools import pairwise

import can
import pytest
from node.bench import Bench, Recorder
from node.rough_bus import (
    RoughBus,
    frames_until,
    is_off,
    is_on,
    raising,
    rest,
    signals,
    trailing_offs,
)

from swapcan import StillActingError
from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import (
    V2B_CMD,
    AccessoryHvCommand,
    HeatCommand,
    HvCommand,
    V2B_RQData,
)
from swapcan.node import BusLost, Node

ON = V2B_CMD(
    hv_on_off=HvCommand.HV_ON,
    hv_acc_on_off=AccessoryHvCommand.HV_ACC_ON,
    heat_on_off=HeatCommand.HEAT_ON,
    vehicle_speed=42.0,
)


def set_on(node: Node) -> None:
    node.set(ON)


def send_on(node: Node) -> None:
    node.send(ON)


def supply_on(node: Node) -> None:
    node.supply(V2B_CMD, lambda: [ON])


def set_one_of_them(node: Node) -> None:
    node.set(V2B_CMD(heat_on_off=HeatCommand.HEAT_ON))


def clear_what_is_on(node: Node) -> None:
    node.send(ON)
    node.clear(V2B_CMD)


@pytest.mark.parametrize("turn_on", [set_on, send_on, supply_on, set_one_of_them, clear_what_is_on])
def test_whatever_is_on_is_off_in_the_last_commands(
    near: can.BusABC, far: can.BusABC, turn_on: Callable[[Node], None]
) -> None:
    with Node(PROTOCOL, "VCU", near) as node:
        turn_on(node)
        heard = frames_until(far, lambda frame: not is_off(frame))
        assert node.acting
    offs = trailing_offs(heard + rest(far))
    assert len(offs) >= 5
    assert node.acting == ()
    gaps = [b.timestamp - a.timestamp for a, b in pairwise(offs[-5:])]
    assert min(gaps) > 0.025  # spread over a quarter of a second: one disturbance ends in less
    assert signals(offs[-1])["V2B_CMD_VehicleSpeed"] == (0 if turn_on is set_one_of_them else 42)


def test_a_node_that_has_commanded_nothing_leaves_at_once_and_says_nothing(
    near: can.BusABC, far: can.BusABC
) -> None:
    with Node(PROTOCOL, "VCU", near) as node:
        node.set(V2B_CMD(hv_on_off=HvCommand.HV_OFF))
        heard = frames_until(far, lambda frame: True)
        start = time.perf_counter()
    assert time.perf_counter() - start < 0.2
    heard += rest(far)
    # Cyclic ones of 50 ms, and no burst in the end.
    assert len(heard) <= 1 + (heard[-1].timestamp - heard[0].timestamp) / 0.05 + 1


def test_a_node_that_is_left_silently_says_nothing(near: can.BusABC, far: can.BusABC) -> None:
    with Node(PROTOCOL, "VCU", near, leave="silent") as node:
        node.set(ON)
        heard = frames_until(far, is_on)
        start = time.perf_counter()
    assert time.perf_counter() - start < 0.2
    assert all(map(is_on, heard + rest(far)))
    assert node.acting == (ON,)
    assert frames_until_quiet(far) == []


def frames_until_quiet(bus: can.BusABC) -> list[can.Message]:
    """What comes in in the time of three periods."""
    frames = []
    while frame := bus.recv(0.15):
        frames.append(frame)
    return frames


def test_off_is_the_last_word_where_sending_fails_at_first(
    rough: RoughBus, far: can.BusABC
) -> None:
    with Node(PROTOCOL, "VCU", rough) as node:
        node.set(ON)
        heard = frames_until(far, is_on)
        rough.before_send = raising(lambda: IndexError("out of range"), times=7)
    assert len(trailing_offs(heard + rest(far))) >= 5
    assert node.acting == ()


def test_a_bus_that_takes_nothing_any_more_is_said_to_be_live(
    rough: RoughBus, far: can.BusABC
) -> None:
    node = Node(PROTOCOL, "VCU", rough)

    def drive() -> None:
        with node:
            node.set(ON)
            frames_until(far, is_on)
            rough.before_send = raising(lambda: OSError(100, "Network is down"))

    with pytest.raises(StillActingError, match="TAKE IT FOR LIVE") as raised:
        drive()
    assert raised.value.messages == ("V2B_CMD",)
    assert "V2B_CMD" in str(raised.value)
    assert "Network is down" in raised.value.cause
    assert isinstance(raised.value.__cause__, OSError)
    with pytest.raises(StillActingError):  # it is tried once more, as often as one asks for it
        node.stop()
    rough.before_send = raising(OSError, times=0)
    rest(far)
    node.stop()
    assert is_off(rest(far)[-1])
    node.stop()
    assert rest(far) == []


def test_an_error_that_a_block_is_left_with_stays_and_gets_a_note(
    rough: RoughBus, far: can.BusABC, caplog: pytest.LogCaptureFixture
) -> None:
    def drive() -> None:
        with Node(PROTOCOL, "VCU", rough) as node:
            node.set(ON)
            frames_until(far, is_on)
            rough.before_send = raising(can.CanOperationError)
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError) as raised:
        drive()
    (said,) = raised.value.__notes__
    assert "TAKE IT FOR LIVE" in said
    assert said in caplog.messages


def test_a_bus_that_was_lost_is_opened_anew_to_end_what_acts(
    open_bus: Callable[..., can.BusABC], far: can.BusABC
) -> None:
    lent = open_bus()
    may_open = threading.Event()

    def reopen() -> can.BusABC:
        if not may_open.is_set():
            raise can.CanInitializationError("no such device")
        return open_bus()

    lost = Recorder()
    node = Node(PROTOCOL, "VCU", lent, reopen=reopen)
    node.start()
    node.set(ON)
    heard = frames_until(far, is_on)
    node.on(BusLost, lost)
    lent.shutdown()
    lost.wait()
    may_open.set()
    node.stop()
    assert len(trailing_offs(heard + rest(far))) >= 5


def test_a_bus_that_only_receives_is_opened_anew_to_end_what_acts(
    rough: RoughBus, open_bus: Callable[..., can.BusABC], far: can.BusABC
) -> None:
    with Node(PROTOCOL, "VCU", rough, reopen=open_bus) as node:
        node.set(ON)
        heard = frames_until(far, is_on)
        rough.before_send = raising(OSError)
    assert len(trailing_offs(heard + rest(far))) >= 5


def test_what_is_opened_and_is_no_bus_does_not_replace_one_that_still_sends(
    rough: RoughBus, far: can.BusABC
) -> None:
    tried = threading.Event()

    def reopen() -> can.BusABC:
        tried.set()
        return None  # type: ignore[return-value]

    with Node(PROTOCOL, "VCU", rough, reopen=reopen) as node:
        node.set(ON)
        heard = frames_until(far, is_on)
        rough.before_recv = raising(OSError)
        assert tried.wait(5)
    assert len(trailing_offs(heard + rest(far))) >= 5


def test_async_with_ends_what_acts(near: can.BusABC, far: can.BusABC) -> None:
    async def scenario() -> list[can.Message]:
        async with Node(PROTOCOL, "VCU", near) as node:
            node.set(ON)
            return await asyncio.to_thread(frames_until, far, is_on)

    heard = asyncio.run(scenario())
    assert len(trailing_offs(heard + rest(far))) >= 5


def test_async_with_tells_what_could_not_be_ended(rough: RoughBus, far: can.BusABC) -> None:
    async def scenario() -> None:
        async with Node(PROTOCOL, "VCU", rough) as node:
            node.set(ON)
            await asyncio.to_thread(frames_until, far, is_on)
            rough.before_send = raising(KeyError)

    with pytest.raises(StillActingError, match="KeyError"):
        asyncio.run(scenario())


def test_a_node_that_is_driven_by_hand_ends_what_acts_when_it_is_stopped(
    bench: Bench, near: can.BusABC, far: can.BusABC
) -> None:
    node = bench.node("VCU", near)
    node.set(ON, V2B_RQData())
    bench.run(0.2)
    heard = rest(far)
    node.send(ON)
    node.stop()
    heard += rest(far)
    assert len(trailing_offs(heard)) == 1
    assert node.acting == ()


def test_an_event_loop_goes_on_while_a_node_ends_what_acts(
    near: can.BusABC, far: can.BusABC
) -> None:
    ticks = 0

    async def tick() -> None:
        nonlocal ticks
        while True:
            ticks += 1
            await asyncio.sleep(0.005)

    async def scenario() -> None:
        async with Node(PROTOCOL, "VCU", near) as node:
            node.set(ON)
            await asyncio.to_thread(frames_until, far, is_on)
            ticking = asyncio.create_task(tick())
        ticking.cancel()

    asyncio.run(scenario())
    assert ticks >= 5  # in a quarter of a second
