"""`Node.events`: what callbacks are told, for ``async for``."""

from __future__ import annotations

import asyncio
import threading

import can
import pytest
from node.bench import Bench

from swapcan import Fault, Received
from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import B2V_ST1, B2V_ST2, V2B_VIN
from swapcan.node import Node
from swapcan.node.answers import Event
from swapcan.transfer import Vin, split_vin
from typedcan.node.events import Overrun
from typedcan.supervise import State, StateChanged


def st2(soc: int) -> can.Message:
    return can.Message(arbitration_id=B2V_ST2.FRAME_ID, data=bytes([soc, *[0] * 7]))


def test_a_stream_has_all_kinds_of_events_in_order(near: can.BusABC, far: can.BusABC) -> None:
    async def scenario() -> list[Event]:
        seen: list[Event] = []
        async with Node(PROTOCOL, "VCU", far) as vcu:
            events = vcu.events()
            near.send(st2(200))
            near.send(can.Message(arbitration_id=B2V_ST1.FRAME_ID, data=bytes(7)))
            async for event in events:
                seen.append(event)
                if isinstance(event, Fault):
                    break
            await events.aclose()
        return seen

    seen = asyncio.run(asyncio.wait_for(scenario(), 5.0))
    assert isinstance(seen[0], Received)
    assert isinstance(seen[0].message, B2V_ST2)
    assert seen[0].message.soc == 80.0
    changed = [event for event in seen if isinstance(event, StateChanged)]
    assert [(event.message, event.new) for event in changed] == [(B2V_ST2, State.ALIVE)]
    assert isinstance(seen[-1], Fault)
    assert seen[-1].kind == "length"


def test_a_stream_has_what_transfers_put_together(near: can.BusABC, far: can.BusABC) -> None:
    async def scenario() -> Event:
        async with Node(PROTOCOL, "BMU", near) as bmu, Node(PROTOCOL, "VCU", far) as vcu:
            events = bmu.events()
            vcu.set(*split_vin("LSVAA4187E2184847"))
            async for event in events:
                if isinstance(event, Vin):
                    await events.aclose()
                    return event
        raise AssertionError

    assert asyncio.run(asyncio.wait_for(scenario(), 5.0)) == Vin("LSVAA4187E2184847")


def test_a_stream_ends_with_its_node(near: can.BusABC, far: can.BusABC) -> None:
    async def scenario() -> int:
        async def count() -> int:
            return len([event async for event in events if isinstance(event, Received)])

        async with Node(PROTOCOL, "VCU", far) as vcu:
            events = vcu.events()
            counting = asyncio.create_task(count())
            for soc in range(5):
                near.send(st2(soc))
            while vcu.counts.received < 5:
                await asyncio.sleep(0.001)
        return await counting

    assert asyncio.run(asyncio.wait_for(scenario(), 5.0)) == 5


def test_a_slow_reader_gets_the_latest_events_and_is_told_what_it_missed(
    near: can.BusABC, far: can.BusABC
) -> None:
    async def scenario() -> list[Event]:
        bench = Bench()
        vcu = bench.node("VCU", far, expect=[])
        vcu.turn()
        events = vcu.events(limit=3)
        for soc in range(10):
            near.send(st2(soc))
        bench.turn()  # ten messages and the change to alive
        first = [await anext(events) for _ in range(4)]
        near.send(st2(99))
        bench.turn()
        last = await anext(events)
        await events.aclose()
        return [*first, last]

    dropped, *rest = asyncio.run(scenario())
    assert dropped == Overrun(8)
    assert all(isinstance(event, Received) for event in rest)
    data = [event.frame.data[0] for event in rest if isinstance(event, Received)]
    assert data == [7, 8, 9, 99]


def test_a_stream_of_a_message_has_nothing_else(near: can.BusABC, far: can.BusABC) -> None:
    async def scenario() -> None:
        bench = Bench()
        vcu = bench.node("VCU", far, expect=[])
        vcu.turn()
        messages, changes = vcu.events(B2V_ST2), vcu.events(StateChanged)
        near.send(can.Message(arbitration_id=B2V_ST1.FRAME_ID, data=bytes(7)))  # refused
        near.send(st2(99))
        near.send(can.Message(arbitration_id=B2V_ST1.FRAME_ID, data=bytes(8)))
        near.send(st2(100))
        bench.turn()
        vcu.stop()
        assert [received.frame.data[0] async for received in messages] == [99, 100]
        assert [change.message async for change in changes] == [B2V_ST2, B2V_ST1]

    asyncio.run(scenario())


def test_what_a_slow_reader_of_one_message_misses_is_logged(
    near: can.BusABC, far: can.BusABC, caplog: pytest.LogCaptureFixture
) -> None:
    async def scenario() -> None:
        bench = Bench()
        vcu = bench.node("VCU", far, expect=[])
        vcu.turn()
        messages = vcu.events(B2V_ST2, limit=2)
        for soc in range(5):
            near.send(st2(soc))
        bench.turn()
        assert [(await anext(messages)).frame.data[0] for _ in range(2)] == [3, 4]
        await messages.aclose()

    asyncio.run(scenario())
    assert [each.getMessage() for each in caplog.records] == ["B2V_ST2: 3 events dropped"]


def test_two_readers_see_the_same_and_one_that_leaves_does_not_end_the_other(
    near: can.BusABC, far: can.BusABC
) -> None:
    async def scenario() -> None:
        bench = Bench()
        vcu = bench.node("VCU", far)
        one, other = vcu.events(), vcu.events()
        near.send(st2(1))
        bench.turn()
        assert await anext(one) == await anext(other)
        await one.aclose()
        near.send(st2(2))
        bench.turn()
        while not (isinstance(event := await anext(other), Received) and event.frame.data[0] == 2):
            pass
        await other.aclose()

    asyncio.run(asyncio.wait_for(scenario(), 5.0))


def test_an_event_loop_that_has_ended_does_not_disturb_the_node(
    near: can.BusABC, far: can.BusABC
) -> None:
    heard = threading.Semaphore(0)
    with Node(PROTOCOL, "VCU", far) as vcu:
        vcu.on(B2V_ST2, lambda received: heard.release())

        async def listen() -> None:
            vcu.events()

        asyncio.run(listen())
        for soc in range(3):
            near.send(st2(soc))
            assert heard.acquire(timeout=2.0)


def test_a_stream_needs_an_event_loop(near: can.BusABC) -> None:
    with pytest.raises(RuntimeError, match="outside of an event loop"):
        Node(PROTOCOL, "VCU", near).events()


def test_the_vin_of_one_node_is_not_put_together_by_itself(
    near: can.BusABC, far: can.BusABC
) -> None:
    bench = Bench()
    vcu = bench.node("VCU", near)
    vcu.on(Vin, lambda vin: pytest.fail("its own"))
    for message in split_vin("LSVAA4187E2184847"):
        far.send(
            can.Message(arbitration_id=V2B_VIN.FRAME_ID, data=bytes([message.frame_no, *[65] * 7]))
        )
    vcu.turn()
