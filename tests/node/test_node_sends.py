"""What a node sends and when: bytes by hand, seen by a bare bus, on a simulated clock."""

from __future__ import annotations

import math
from collections.abc import Iterator

import can
import pytest
from defaults import default_of
from node.bench import Bench, Ear, Recorder, frames_on, gaps

from swapcan import EncodeError, Message
from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import (
    B2V_RQ,
    B2V_ST1,
    B2V_ST2,
    BMS_TMS_0,
    V2B_CMD,
    V2B_VIN,
    B2V_ElecEnergy,
    B2V_Ucell,
)
from swapcan.node import Node
from typedcan.node.events import SendFailed
from typedcan.wire.errors import SendingError, UnknownNodeError


def test_a_cyclic_message_goes_out_with_the_period_of_the_standard(
    bench: Bench, near: can.BusABC, ear: Ear
) -> None:
    bench.node("BMU", near).set(B2V_ST2(soc=80.0), B2V_ElecEnergy())
    ear.run(1.0)
    assert len(ear.times(B2V_ST2)) == 10
    assert gaps(ear.times(B2V_ST2)) == pytest.approx([0.1] * 9, abs=0.0011)
    assert set(ear.data(B2V_ST2)) == {"c8ffffffffffffff"}
    assert len(ear.times(B2V_ElecEnergy)) == 1


def test_a_period_of_ones_own_holds_also_for_a_message_without_any(
    bench: Bench, near: can.BusABC, ear: Ear
) -> None:
    node = bench.node("BMU", near)
    node.set(B2V_ST2(), period=0.02)
    node.set(B2V_RQ(), period=0.05)
    ear.run(0.5)
    assert gaps(ear.times(B2V_ST2)) == pytest.approx([0.02] * 24, abs=0.0011)
    assert gaps(ear.times(B2V_RQ)) == pytest.approx([0.05] * 9, abs=0.0011)


def test_counters_and_checksums_are_made_for_each_transmission(
    bench: Bench, near: can.BusABC, ear: Ear
) -> None:
    bench.node("VCU", near).set(V2B_CMD())
    ear.run(0.84)
    sent = ear.data(V2B_CMD)
    assert len(sent) == 16
    # The counter is the low half of byte 1 and runs 0 to 14; byte 0 is the XOR of the others.
    assert [int(data[3], 16) for data in sent] == [*range(15), 0]
    for data in sent:
        first, *rest = bytes.fromhex(data)
        for byte in rest:
            first ^= byte
        assert first == 0


def test_new_values_go_out_without_a_change_of_rhythm_or_counter(
    bench: Bench, near: can.BusABC, ear: Ear
) -> None:
    node = bench.node("BMU", near)
    node.set(default_of(BMS_TMS_0, volt=1), period=0.1)
    ear.run(0.25)
    node.set(default_of(BMS_TMS_0, volt=2))
    ear.run(0.55)
    assert gaps(ear.times(BMS_TMS_0)) == pytest.approx([0.1] * 4, abs=0.0011)
    volts_and_counters = [(data[2:6], data[12:14]) for data in ear.data(BMS_TMS_0)]
    assert [volt for volt, _ in volts_and_counters[-3:]] == ["0002"] * 3
    assert [counter for _, counter in volts_and_counters] == ["00", "01", "02", "03", "04"]


def test_event_messages_go_out_once_and_in_order(bench: Bench, near: can.BusABC, ear: Ear) -> None:
    bench.node("VCU", near).set(*(V2B_VIN(frame_no=number) for number in (1, 2, 3)))
    ear.run(2.0)
    assert [data[:2] for data in ear.data(V2B_VIN)] == ["01", "02", "03"]


def test_the_frames_of_a_cycle_are_spread_evenly(bench: Bench, near: can.BusABC, ear: Ear) -> None:
    bench.node("BMU", near).set(*(B2V_Ucell(csc_no=1, frame_no=n) for n in (1, 2, 3, 4)))
    ear.run(0.31)
    assert gaps(ear.times(B2V_Ucell))[:8] == pytest.approx([0.025] * 8, abs=0.0011)
    numbers = [data[:2] for data in ear.data(B2V_Ucell)]
    assert numbers[:8] == ["01", "02", "03", "04", "01", "02", "03", "04"]


def test_frames_change_with_the_cycle_and_never_within_it(
    bench: Bench, near: can.BusABC, ear: Ear
) -> None:
    node = bench.node("BMU", near)
    node.set(*(B2V_Ucell(csc_no=1, frame_no=n) for n in (1, 2, 3, 4)))
    while len(ear.heard) < 2:
        ear.run(bench.clock.now() + 0.001)
    node.set(*(B2V_Ucell(csc_no=2, frame_no=n) for n in (1, 2)))
    ear.run(bench.clock.now() + 0.25)
    assert [data[:4] for data in ear.data(B2V_Ucell)][:7] == [
        *("0101", "0201", "0301", "0401"),
        *("0102", "0202", "0102"),
    ]


def test_a_maker_is_asked_for_each_cycle_anew(bench: Bench, near: can.BusABC, ear: Ear) -> None:
    socs = iter((10.0, 20.0, 30.0, 40.0))
    bench.node("BMU", near).supply(B2V_ST2, lambda: [B2V_ST2(soc=next(socs))])
    ear.run(0.35)
    # 10 % / 0.4 = 25, and so on
    assert [int(data[:2], 16) for data in ear.data(B2V_ST2)] == [25, 50, 75]


def test_a_maker_that_fails_leaves_its_cycle_out_and_stops_nothing(
    bench: Bench, near: can.BusABC, ear: Ear, caplog: pytest.LogCaptureFixture
) -> None:
    calls = 0

    def make() -> Iterator[B2V_ST2]:
        nonlocal calls
        calls += 1
        if calls == 2:
            raise ZeroDivisionError
        yield B2V_ST2()

    node = bench.node("BMU", near)
    node.supply(B2V_ST2, make)
    node.set(B2V_ST1())
    ear.run(0.45)
    assert len(ear.times(B2V_ST2)) == 3
    assert gaps(ear.times(B2V_ST1)) == pytest.approx([0.1] * 4, abs=0.0011)
    (record,) = caplog.records
    assert record.name == "typedcan"
    assert record.exc_info
    assert record.exc_info[0] is ZeroDivisionError


@pytest.mark.parametrize("wrong", [B2V_ST2(soc=500.0), B2V_ST1()])
def test_what_a_maker_returns_that_cannot_be_sent_is_reported_once(
    bench: Bench, near: can.BusABC, ear: Ear, wrong: Message
) -> None:
    failed = Recorder()
    node = bench.node("BMU", near)
    node.on(SendFailed, failed)
    node.supply(B2V_ST2, lambda: [wrong])
    ear.run(0.5)
    assert ear.heard == []
    (event,) = failed.seen
    assert event.message is B2V_ST2
    assert "500 %" in event.error or "not B2V_ST1" in event.error


def test_what_is_cleared_is_sent_no_more(bench: Bench, near: can.BusABC, ear: Ear) -> None:
    node = bench.node("BMU", near)
    node.set(B2V_ST1(), B2V_ST2(), B2V_RQ())
    node.clear(B2V_RQ)
    ear.run(0.2)
    node.clear(B2V_ST2)
    before = len(ear.times(B2V_ST2))
    ear.run(0.5)
    assert before > 0
    assert len(ear.times(B2V_ST2)) == before
    assert len(ear.times(B2V_ST1)) == 5
    assert ear.times(B2V_RQ) == []
    assert node.next_due < math.inf
    node.clear(B2V_ST1)
    ear.run(0.7)
    assert len(ear.times(B2V_ST1)) == 5


def test_one_frame_can_be_sent_at_once(near: can.BusABC, far: can.BusABC) -> None:
    node = Node(PROTOCOL, "BMU", near)
    node.send(default_of(BMS_TMS_0))
    node.send(default_of(BMS_TMS_0))
    assert [frame.data[6] for frame in frames_on(far)] == [0, 1]


def test_a_postponed_frame_is_late_and_the_next_is_in_time(
    bench: Bench, near: can.BusABC, ear: Ear
) -> None:
    node = bench.node("BMU", near)
    node.set(B2V_ST2())
    ear.run(0.2)
    node.postpone(B2V_ST2, 0.06)
    ear.run(0.5)
    assert gaps(ear.times(B2V_ST2)) == pytest.approx([0.1, 0.16, 0.04, 0.1], abs=0.0011)


def test_only_what_is_being_sent_can_be_postponed(near: can.BusABC) -> None:
    with pytest.raises(SendingError, match="B2V_ST2 is not being sent"):
        Node(PROTOCOL, "BMU", near).postpone(B2V_ST2, 1.0)


def test_a_node_sends_its_own_messages_only(near: can.BusABC, bench: Bench, ear: Ear) -> None:
    node = bench.node("BMU", near)
    problem = "BMU does not send V2B_CMD: VCU does"
    with pytest.raises(SendingError, match=problem):
        node.set(B2V_ST2(), V2B_CMD())
    with pytest.raises(SendingError, match=problem):
        node.send(V2B_CMD())
    with pytest.raises(SendingError, match=problem):
        node.supply(V2B_CMD, list)
    with pytest.raises(SendingError, match=problem):
        node.provide(V2B_CMD())
    ear.run(0.2)
    assert ear.heard == []


def test_a_value_that_cannot_be_sent_is_refused_at_once_and_nothing_is_set(
    bench: Bench, near: can.BusABC, ear: Ear
) -> None:
    node = bench.node("BMU", near)
    with pytest.raises(EncodeError) as refused:
        node.set(B2V_ST1(), B2V_RQ(), B2V_ST2(soc=102.4))
    assert (refused.value.message, refused.value.field) == ("B2V_ST2", "soc")
    ear.run(0.3)
    assert ear.heard == []


@pytest.mark.parametrize("period", [0.0, -0.1, math.inf, math.nan])
def test_a_period_that_is_none_is_refused(near: can.BusABC, period: float) -> None:
    node = Node(PROTOCOL, "BMU", near)
    with pytest.raises(SendingError, match="positive number of seconds"):
        node.set(B2V_ST2(), period=period)
    with pytest.raises(SendingError, match="positive number of seconds"):
        node.supply(B2V_ST2, list, period=period)


def test_a_maker_of_a_message_without_a_period_needs_one(near: can.BusABC) -> None:
    with pytest.raises(SendingError, match="B2V_RQ has no period"):
        Node(PROTOCOL, "BMU", near).supply(B2V_RQ, list)


def test_an_unknown_node_is_refused(near: can.BusABC) -> None:
    with pytest.raises(UnknownNodeError, match="'ECU'"):
        Node(PROTOCOL, "ECU", near)
