"""Alive counters on receipt: which values are right, and what a wrong one does."""

from __future__ import annotations

from collections.abc import Callable

import can
import pytest
from runtime.frames import frame, life, live, st1

from swapcan import PROTOCOL, Counts, Fault, Link, SignalState
from swapcan.messages import B2V_ST1, B2V_ST2, BMS_TMS_0, BSU_BMS_0, BmsState
from typedcan.wire.codec import Codec
from typedcan.wire.link import Link as BareLink


def counter_faults(link: Link, count: int) -> list[str]:
    """The text of each message's fault, empty where it has none."""
    texts = []
    for _ in range(count):
        faults = link.receive().faults
        assert len(faults) <= 1
        assert all(fault.kind == "counter" for fault in faults)
        texts.append("".join(fault.text for fault in faults))
    return texts


def test_an_alive_counter_of_four_bits_runs_0_to_14(near: can.BusABC, far: can.BusABC) -> None:
    link = Link(near)
    for number in range(12, 32):
        far.send(st1(number % 15))
    assert counter_faults(link, 20) == [""] * 20


@pytest.mark.parametrize("make", [life, live])
def test_a_life_counter_runs_0_to_255(
    near: can.BusABC, far: can.BusABC, make: Callable[[int], can.Message]
) -> None:
    link = Link(near)
    for number in range(250, 260):
        far.send(make(number % 256))
    assert counter_faults(link, 10) == [""] * 10


@pytest.mark.parametrize(
    ("counters", "faults"),
    [
        ([5, 5, 6], ["", "counter stays at 5", ""]),
        ([5, 7, 8], ["", "counter goes from 5 to 7, expected 6", ""]),
        ([5, 4, 5], ["", "counter goes from 5 to 4, expected 6", ""]),
        ([14, 1], ["", "counter goes from 14 to 1, expected 0"]),
        ([14, 15, 0], ["", "counter is Signal Invalid, it runs 0 to 14", ""]),
        ([5, 15, 9, 10], ["", "counter is Signal Invalid, it runs 0 to 14", "", ""]),
        ([15, 15], ["counter is Signal Invalid, it runs 0 to 14"] * 2),
    ],
)
def test_a_wrong_counter_is_reported_with_the_message(
    near: can.BusABC, far: can.BusABC, counters: list[int], faults: list[str]
) -> None:
    reported: list[Fault] = []
    link = Link(near, on_fault=reported.append)
    for counter in counters:
        far.send(st1(counter))
    assert counter_faults(link, len(counters)) == faults
    assert [fault.text for fault in reported] == [text for text in faults if text]
    assert link.counts == Counts(received=len(counters), counter=len(reported))


def test_a_message_with_a_wrong_counter_is_whole(near: can.BusABC, far: can.BusABC) -> None:
    link = Link(near)
    far.send(frame(0x1881D0F3, bytes.fromhex("2f2f000000000000")))
    received = link.receive()
    assert isinstance(received.message, B2V_ST1)
    assert received.message.bms is BmsState.HV_CLOSED
    assert received.message.aliv is SignalState.INVALID
    assert [fault.frame for fault in received.faults] == [received.frame]


def test_the_counters_of_two_messages_do_not_mix(near: can.BusABC, far: can.BusABC) -> None:
    link = Link(near)
    for each in (life(7), live(200), life(8), live(201)):
        far.send(each)
    kinds = [(type(link.receive().message)) for _ in range(4)]
    assert kinds == [BMS_TMS_0, BSU_BMS_0, BMS_TMS_0, BSU_BMS_0]
    assert link.counts.faults == 0


def test_a_frame_with_a_wrong_checksum_does_not_move_the_counter(
    near: can.BusABC, far: can.BusABC
) -> None:
    link = Link(near)
    broken = st1(7)
    broken.data[0] ^= 1
    for each in (st1(3), broken, st1(4)):
        far.send(each)
    assert [link.receive().faults for _ in range(2)] == [(), ()]


def test_a_protocol_stands_for_its_own_codec(near: can.BusABC) -> None:
    sent = BareLink(near, PROTOCOL).send(B2V_ST2(soc=80.0))
    assert sent.data == BareLink(near, Codec(PROTOCOL)).send(B2V_ST2(soc=80.0)).data
