"""Requests: asked on the bus, answered by another node or by hand, and withdrawn."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import CancelledError
from typing import Any

import can
import pytest
from node.bench import Bench, frames_on

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import (
    B2V_RQ,
    B2V_BattInfo1,
    B2V_BattInfo2,
    HvOffRequest,
    Manufacturer,
    V2B_RQData,
)
from swapcan.node import Node
from swapcan.node.answers import BatteryInfo
from swapcan.transfer import PackCode, Vin, split_pack_code, split_vin
from typedcan.node.errors import RequestError, RequestTimeoutError
from typedcan.node.request import Pending

CODE = "001PB0A1234567890123ABCD"
VIN = "LSVAA4187E2184847"


def asked(bus: can.BusABC) -> list[int]:
    """Byte 1 of each V2B_RQData: RQBattInfo in bits 0 and 1, RQSysCode in bits 2 and 3."""
    return [f.data[1] for f in frames_on(bus) if f.arbitration_id == V2B_RQData.FRAME_ID]


def test_battery_info_is_asked_for_until_it_is_there_and_then_withdrawn(
    bench: Bench, near: can.BusABC, far: can.BusABC, open_bus: Callable[..., can.BusABC]
) -> None:
    tap = open_bus()
    bmu, vcu = bench.node("BMU", near), bench.node("VCU", far)
    info1, info2 = B2V_BattInfo1(), B2V_BattInfo2(tot_csc_num=18, tot_cell_num=216)
    bmu.provide(info1, info2)
    pending = vcu.request_battery_info()
    assert not pending.done()
    bench.run(0.5)
    assert pending.done()
    assert pending.result(0) == BatteryInfo(info1, info2)
    # 1 asks, 2 takes it back; the pack code is not asked for (2) at any time.
    assert asked(tap) == [0b1001, 0b1010]
    bench.run(2.0)
    assert frames_on(tap) == []


def test_the_vin_is_asked_for_by_the_bmu(bench: Bench, near: can.BusABC, far: can.BusABC) -> None:
    bmu, vcu = bench.node("BMU", near), bench.node("VCU", far)
    vcu.provide(*split_vin(VIN))
    pending = bmu.request_vin()
    bench.run(0.1)
    assert pending.result(0) == Vin(VIN)


def test_the_pack_code_counts_once_it_has_come_twice(
    bench: Bench, near: can.BusABC, far: can.BusABC
) -> None:
    bmu, vcu = bench.node("BMU", near), bench.node("VCU", far)
    bmu.provide(*split_pack_code(CODE, Manufacturer.CATL))
    pending = vcu.request_pack_code()
    bench.run(0.9)
    assert not pending.done()
    bench.run(1.3)
    assert pending.result(0) == PackCode(CODE, Manufacturer.CATL)


def test_two_requests_at_a_time_share_their_message(
    bench: Bench, near: can.BusABC, far: can.BusABC, open_bus: Callable[..., can.BusABC]
) -> None:
    tap = open_bus()
    bmu, vcu = bench.node("BMU", near), bench.node("VCU", far)
    bmu.provide(*split_pack_code(CODE), B2V_BattInfo1(), B2V_BattInfo2())
    code = vcu.request_pack_code(again=10.0)
    info = vcu.request_battery_info(again=10.0)
    bench.run(0.5)
    assert (info.done(), code.done()) == (True, False)
    bench.run(2.0)
    assert code.done()
    assert asked(tap) == [0b0110, 0b0101, 0b0110, 0b1010]


def test_other_fields_of_the_message_that_asks_stay_as_they_were(
    bench: Bench, near: can.BusABC, far: can.BusABC
) -> None:
    bmu = bench.node("BMU", near)
    bmu.set(B2V_RQ(hv_off=HvOffRequest(1)))
    bmu.request_vin()
    bench.run(0.1)
    # B2V_RQ: VIN in bits 0 and 1, HVOff in bits 2 and 3 of byte 0; 3 is invalid.
    assert [frame.data[0] & 0b1111 for frame in frames_on(far)] == [0b0111, 0b0101]


def test_a_request_is_repeated_each_second_where_its_frame_was_lost(
    bench: Bench, near: can.BusABC, far: can.BusABC
) -> None:
    vcu = bench.node("VCU", near)
    vcu.request_battery_info(timeout=3.5)
    bench.run(3.4)
    assert asked(far) == [0b1001] * 4
    bench.run(5.0)
    assert asked(far) == [0b1010]


@pytest.mark.parametrize(
    ("answer", "missing"),
    [
        ([], "B2V_BattInfo1 and B2V_BattInfo2 have not come"),
        ([bytes(8)], "B2V_BattInfo2 has not come"),
    ],
)
def test_a_request_that_is_not_answered_says_what_is_missing(
    bench: Bench, near: can.BusABC, far: can.BusABC, answer: list[bytes], missing: str
) -> None:
    pending = bench.node("VCU", near).request_battery_info(timeout=2.0)
    for data in answer:
        far.send(can.Message(arbitration_id=B2V_BattInfo1.FRAME_ID, data=data))
    bench.run(1.9)
    assert not pending.done()
    bench.run(2.1)
    with pytest.raises(RequestTimeoutError, match=missing) as late:
        pending.result(0)
    assert (late.value.request, late.value.timeout) == ("battery info", 2.0)


def test_a_transfer_that_stays_incomplete_says_which_frame_is_missing(
    bench: Bench, near: can.BusABC, far: can.BusABC
) -> None:
    vcu = bench.node("VCU", far)
    bmu = bench.node("BMU", near)
    first, _, third = split_vin(VIN)
    vcu.provide(first, third)
    pending = bmu.request_vin(timeout=2.5)
    bench.run(3.0)
    with pytest.raises(RequestTimeoutError, match="frame 2 of 3 is missing"):
        pending.result(0)


def test_a_value_that_was_under_way_before_the_request_is_no_answer(
    bench: Bench, near: can.BusABC, far: can.BusABC
) -> None:
    bmu, vcu = bench.node("BMU", near), bench.node("VCU", far)
    old, new = split_vin(VIN), split_vin("LSVAA4187E2199999")
    vcu.set(*old[:2])
    bench.run(0.1)
    vcu.provide(*new)
    pending = bmu.request_vin()
    bench.run(0.5)
    assert str(pending.result(0)) == "LSVAA4187E2199999"


def test_a_cancelled_request_is_withdrawn(bench: Bench, near: can.BusABC, far: can.BusABC) -> None:
    vcu = bench.node("VCU", near)
    pending = vcu.request_battery_info()
    bench.run(0.1)
    assert pending.cancel()
    bench.run(5.0)
    assert asked(far) == [0b1001, 0b1010]
    with pytest.raises(CancelledError):
        pending.result(0)
    vcu.request_battery_info()


def test_a_request_under_way_is_not_made_twice(bench: Bench, near: can.BusABC) -> None:
    vcu = bench.node("VCU", near)
    vcu.request_pack_code()
    with pytest.raises(RequestError, match="under way"):
        vcu.request_pack_code()


@pytest.mark.parametrize(
    ("name", "ask"),
    [
        ("VCU", Node.request_vin),
        ("BMU", Node.request_pack_code),
        ("CHG", Node.request_battery_info),
    ],
)
def test_a_node_without_that_request_cannot_make_it(
    bench: Bench, near: can.BusABC, name: str, ask: Callable[[Node], Pending[Any]]
) -> None:
    with pytest.raises(RequestError, match=f"{name} has no request for the "):
        ask(bench.node(name, near))


def test_a_request_can_be_awaited(near: can.BusABC, far: can.BusABC) -> None:
    async def scenario() -> tuple[Vin, BatteryInfo]:
        async with Node(PROTOCOL, "BMU", near) as bmu, Node(PROTOCOL, "VCU", far) as vcu:
            vcu.provide(*split_vin(VIN))
            bmu.provide(B2V_BattInfo1(), B2V_BattInfo2())
            vin, info = bmu.request_vin(), vcu.request_battery_info()
            return await vin, await info

    vin, info = asyncio.run(scenario())
    assert vin == Vin(VIN)
    assert info == BatteryInfo(B2V_BattInfo1(), B2V_BattInfo2())


def test_a_request_can_be_waited_for(near: can.BusABC, far: can.BusABC) -> None:
    with Node(PROTOCOL, "BMU", near) as bmu, Node(PROTOCOL, "VCU", far) as vcu:
        vcu.provide(*split_vin(VIN))
        assert bmu.request_vin().result(5.0) == Vin(VIN)


def test_a_request_times_out_on_the_event_loop_and_is_withdrawn(
    near: can.BusABC, far: can.BusABC
) -> None:
    async def scenario() -> None:
        async with Node(PROTOCOL, "VCU", near) as vcu:
            with pytest.raises(RequestTimeoutError):
                await vcu.request_battery_info(timeout=0.2)

    asyncio.run(scenario())
    assert asked(far) == [0b1001, 0b1010]


def test_cancelling_the_task_that_awaits_withdraws_the_request(
    near: can.BusABC, far: can.BusABC
) -> None:
    async def scenario() -> None:
        async with Node(PROTOCOL, "VCU", near) as vcu:
            with pytest.raises(TimeoutError):
                await asyncio.wait_for(vcu.request_battery_info(), 0.1)

    asyncio.run(scenario())
    assert asked(far) == [0b1001, 0b1010]


def test_stopping_a_node_ends_and_withdraws_its_requests(near: can.BusABC, far: can.BusABC) -> None:
    with Node(PROTOCOL, "VCU", near) as vcu:
        pending = vcu.request_battery_info()
    with pytest.raises(RequestError, match="was stopped"):
        pending.result(0)
    assert asked(far)[-1] == 0b1010
