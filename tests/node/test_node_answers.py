"""Answers to requests: asked for by hand on the bus, on a simulated clock."""

from __future__ import annotations

from collections.abc import Callable

import can
import pytest
from node.bench import Bench, Ear, Recorder, gaps

from swapcan.messages import (
    B2V_RQ,
    V2B_VIN,
    B2V_BattInfo1,
    B2V_SysCode2,
    V2B_RQData,
    VinRequest,
)


def request(**codes: int) -> can.Message:
    """V2B_RQData: codes in bits 8 to 9 and 10 to 11, byte 0 the XOR of the others."""
    byte = codes.get("info", 3) | codes.get("code", 3) << 2
    return can.Message(arbitration_id=0x1801F3EF, data=bytes([byte, byte, 0, 0, 0, 0, 0, 0]))


def test_an_answer_with_a_period_is_sent_while_it_is_requested(
    bench: Bench, near: can.BusABC, far: can.BusABC, ear: Ear
) -> None:
    node = bench.node("BMU", near)
    node.provide(B2V_BattInfo1(), B2V_SysCode2())
    ear.run(0.3)
    assert ear.heard == []
    far.send(request(info=1))
    ear.run(0.8)
    assert gaps(ear.times(B2V_BattInfo1)) == pytest.approx([0.1] * 4, abs=0.0011)
    far.send(request())  # says nothing about it
    ear.run(1.0)
    assert len(ear.times(B2V_BattInfo1)) == 7
    far.send(request(info=2))
    ear.run(1.5)
    assert len(ear.times(B2V_BattInfo1)) == 7
    assert ear.times(B2V_SysCode2) == []


def test_what_is_provided_after_the_request_is_sent_all_the_same(
    bench: Bench, near: can.BusABC, far: can.BusABC, ear: Ear
) -> None:
    node = bench.node("BMU", near)
    far.send(request(info=1))
    ear.run(0.1)
    node.provide_from(B2V_BattInfo1, lambda: [B2V_BattInfo1()])
    ear.run(0.5)
    assert len(ear.times(B2V_BattInfo1)) == 4


def test_an_answer_without_a_period_is_sent_once_for_each_request(
    bench: Bench, near: can.BusABC, far: can.BusABC, ear: Ear
) -> None:
    bench.node("VCU", near).provide(*(V2B_VIN(frame_no=number) for number in (1, 2, 3)))
    asking = can.Message(
        arbitration_id=B2V_RQ.FRAME_ID, data=bytes([VinRequest.REQUEST_VIN, *[0] * 7])
    )
    far.send(asking)
    far.send(asking)  # while the answer is on its way
    ear.run(0.5)
    assert [data[:2] for data in ear.data(V2B_VIN)] == ["01", "02", "03"]
    assert gaps(ear.times(V2B_VIN)) == pytest.approx([0.005, 0.005], abs=0.0011)
    far.send(asking)
    ear.run(1.0)
    assert len(ear.times(V2B_VIN)) == 6


def test_a_request_of_the_node_itself_that_comes_back_is_not_answered(
    open_bus: Callable[..., can.BusABC], bench: Bench, ear: Ear
) -> None:
    loud = open_bus(receive_own_messages=True)
    node = bench.node("VCU", loud)
    received = Recorder()
    node.on(V2B_RQData, received)
    node.set(V2B_RQData(rq_batt_info=1))
    ear.run(0.2)
    assert len(ear.times(V2B_RQData)) == 1
    assert received.seen == []
    assert node.counts.received == 0
