"""`Link.listen`: messages in an event loop, and what is left when the loop is left."""

from __future__ import annotations

import asyncio
import contextlib
import threading

import can
import pytest
from can.interfaces.virtual import VirtualBus
from runtime.frames import live

from swapcan import Fault, Link
from swapcan.messages import B2V_ST2, BSU_BMS_0


def threads() -> list[threading.Thread]:
    return [each for each in threading.enumerate() if each.name.startswith("typedcan")]


async def first(link: Link, count: int) -> list[int | None]:
    counters: list[int | None] = []
    async for received in link.listen():
        assert isinstance(received.message, BSU_BMS_0)
        counters.append(received.message.live)
        if len(counters) == count:
            break
    return counters


def test_messages_arrive_in_an_event_loop(near: can.BusABC, far: can.BusABC) -> None:
    for counter in range(5):
        far.send(live(counter))
    assert asyncio.run(first(Link(near), 5)) == [0, 1, 2, 3, 4]


def test_leaving_the_loop_stops_its_thread_and_leaves_the_bus_open(
    near: can.BusABC, far: can.BusABC
) -> None:
    link = Link(near)
    for counter in range(3):
        far.send(live(counter))
    assert asyncio.run(first(link, 2)) == [0, 1]
    for thread in threads():
        thread.join(5.0)
    assert threads() == []
    received = link.receive()
    assert isinstance(received.message, BSU_BMS_0)
    assert (received.message.live, received.faults) == (2, ())


def test_faults_are_reported_in_the_event_loop(near: can.BusABC, far: can.BusABC) -> None:
    faults: list[tuple[str, threading.Thread]] = []

    def on_fault(fault: Fault) -> None:
        faults.append((fault.kind, threading.current_thread()))

    far.send(can.Message(arbitration_id=0x123, is_extended_id=False))
    far.send(can.Message(arbitration_id=0x18FFF8A7, data=bytes(7)))
    far.send(can.Message(arbitration_id=0x1881D0F3, data=[1, 0, 0, 0, 0, 0, 0, 0]))
    far.send(live(3))
    far.send(live(5))
    link = Link(near, on_fault=on_fault)
    assert asyncio.run(first(link, 2)) == [3, 5]
    main = threading.main_thread()
    assert faults == [("length", main), ("checksum", main), ("counter", main)]
    assert link.counts.foreign == 1


class SlowBus(VirtualBus):
    """A bus on which nothing comes for some calls."""

    silent = 3

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        self.silent -= 1
        return (None, True) if self.silent >= 0 else super()._recv_internal(timeout)

    def recv(self, timeout: float | None = None) -> can.Message | None:
        return self._recv_internal(timeout)[0]


def test_a_bus_that_is_silent_for_a_while_is_listened_to_on(channel: str, far: can.BusABC) -> None:
    with SlowBus(channel) as bus:
        far.send(live(7))
        assert asyncio.run(first(Link(bus), 1)) == [7]


class WatchedBus(VirtualBus):
    """A bus that tells when somebody waits for a frame."""

    waited_for: threading.Event

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        self.waited_for.set()
        return super()._recv_internal(timeout)


def test_a_frame_that_arrives_while_listening_is_cancelled_is_not_lost(
    channel: str, far: can.BusABC
) -> None:
    async def scenario(bus: WatchedBus) -> None:
        listening = asyncio.create_task(first(link, 1))
        await asyncio.to_thread(bus.waited_for.wait)
        listening.cancel()
        far.send(live(1))
        with contextlib.suppress(asyncio.CancelledError):
            await listening
        assert listening.cancelled()

    with WatchedBus(channel) as bus:
        bus.waited_for = threading.Event()
        link = Link(bus)
        asyncio.run(scenario(bus))
        far.send(live(2))
        received = [link.receive(timeout=0) for _ in range(2)]
    assert [each.frame.data[0] for each in received] == [1, 2]
    assert link.counts.faults == 0


def test_a_time_limit_around_the_loop_works_on_a_silent_bus(near: can.BusABC) -> None:
    async def scenario() -> None:
        with pytest.raises(TimeoutError):
            async with asyncio.timeout(0.05):
                await first(Link(near), 1)

    asyncio.run(scenario())
    for thread in threads():
        thread.join(5.0)
    assert threads() == []


def test_the_event_loop_runs_on_while_the_bus_is_silent(near: can.BusABC, far: can.BusABC) -> None:
    async def scenario() -> int:
        listening = asyncio.create_task(first(Link(near), 1))
        turns = 0
        while turns < 1000:
            await asyncio.sleep(0)
            turns += 1
        assert not listening.done()
        far.send(live(0))
        await listening
        return turns

    assert asyncio.run(scenario()) == 1000


def test_both_ends_talk_in_one_event_loop(near: can.BusABC, far: can.BusABC) -> None:
    one, other = Link(near), Link(far)

    async def answer() -> None:
        async for received in other.listen():
            assert isinstance(received.message, B2V_ST2)
            other.send(BSU_BMS_0())
            return

    async def scenario() -> list[int | None]:
        answering = asyncio.create_task(answer())
        listening = asyncio.create_task(first(one, 1))
        one.send(B2V_ST2(soc=50.0))
        await answering
        return await listening

    assert asyncio.run(scenario()) == [0]


def test_the_loop_ends_when_the_bus_is_shut_down(near: can.BusABC, far: can.BusABC) -> None:
    async def scenario() -> int:
        count = 0
        async for _ in Link(near).listen():
            count += 1
            near.shutdown()
        return count

    far.send(live(0))
    assert asyncio.run(scenario()) == 1


class QuietBus(VirtualBus):
    """A bus that does not say so when it is shut down: it only has nothing more."""

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        return (None, False) if self._is_shutdown else super()._recv_internal(timeout)


def test_the_loop_ends_where_a_bus_falls_silent_when_it_is_shut_down(
    channel: str, far: can.BusABC
) -> None:
    async def scenario(bus: can.BusABC) -> int:
        count = 0
        async for _ in Link(bus).listen():
            count += 1
            bus.shutdown()
        return count

    with QuietBus(channel) as bus:
        far.send(live(0))
        assert asyncio.run(scenario(bus)) == 1


class BrokenBus(VirtualBus):
    """A bus whose adapter was pulled out."""

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        raise can.CanOperationError("adapter is gone")


def test_an_error_of_the_bus_reaches_the_consumer(channel: str) -> None:
    with BrokenBus(channel) as bus, pytest.raises(can.CanOperationError, match="adapter is gone"):
        asyncio.run(first(Link(bus), 1))
