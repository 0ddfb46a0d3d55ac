"""Whatever exception a bus, a checksum, a maker or a callback raises, the node goes on."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import can
import pytest
from node.bench import Bench, Recorder, frames_on
from node.rough_bus import (
    ERRORS,
    MuteError,
    RoughBus,
    commands,
    frames_until,
    is_off,
    is_on,
    raising,
    rest,
    trailing_offs,
)

from swapcan import Codec, StillActingError, encode
from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import (
    B2V_RQ,
    B2V_ST1,
    B2V_ST2,
    BMS_TMS_0,
    TMS_BMS_0,
    V2B_CMD,
    V2B_VIN,
    HvCommand,
    HvRequest,
)
from swapcan.node import BusBack, BusLost, Node, ReceiveFailed, SendFailed
from typedcan.supervise import State

ON = V2B_CMD(hv_on_off=HvCommand.HV_ON)
REQUEST = BMS_TMS_0(reqst_tms_hv_on=HvRequest.REQUEST_HV_OFF)

Make = Callable[[], Exception]

pytestmark = [
    pytest.mark.parametrize("error", ERRORS.values(), ids=ERRORS),
    pytest.mark.usefixtures("hurried_leaving"),
]


def st2() -> can.Message:
    return can.Message(arbitration_id=B2V_ST2.FRAME_ID, data=bytes(8))


def is_shown(text: str, error: Make) -> bool:
    """Whether a text says what an error says, or what it is where it says nothing."""
    shown = error()
    said = "" if isinstance(shown, MuteError) else str(shown)
    return (said or type(shown).__name__) in text and "\n" not in text


def test_of_recv_once_it_is_reported_and_what_comes_next_is_heard(
    rough: RoughBus, far: can.BusABC, error: Make
) -> None:
    lost, back, heard = Recorder(), Recorder(), Recorder()
    with Node(PROTOCOL, "VCU", rough) as node:
        for kind, recorder in ((BusLost, lost), (BusBack, back), (B2V_ST2, heard)):
            node.on(kind, recorder)
        rough.before_recv = raising(error, times=1)
        back.wait()
        far.send(st2())
        heard.wait()
    (event,) = lost.seen
    assert is_shown(event.error, error)
    assert len(back.seen) == 1


def test_of_recv_for_good_it_is_tried_again_ever_more_rarely_and_time_passes(
    bench: Bench, rough: RoughBus, far: can.BusABC, error: Make
) -> None:
    lost, back = Recorder(), Recorder()
    node = bench.node("VCU", rough)
    node.on(BusLost, lost)
    node.on(BusBack, back)
    far.send(st2())
    bench.run(0.01)
    rough.before_recv = raising(error)
    tries = []
    while bench.clock.now() < 8.0:
        before = rough.tried_to_recv
        bench.run(round(bench.clock.now() + 0.01, 2))
        if rough.tried_to_recv > before:
            tries.append(bench.clock.now())
    gaps = [b - a for a, b in pairwise(tries)]
    assert gaps == pytest.approx([0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 2.0, 2.0], abs=0.025)
    assert node.state(B2V_ST2) is State.LOST
    rough.before_recv = raising(error, times=0)
    far.send(st2())
    bench.run(12.0)
    assert (len(lost.seen), len(back.seen)) == (1, 1)
    assert node.counts.received == 2


def test_of_send_it_is_reported_once_until_the_message_can_be_sent_again(
    rough: RoughBus, far: can.BusABC, error: Make
) -> None:
    failed, lost, back = Recorder(), Recorder(), Recorder()
    with Node(PROTOCOL, "VCU", rough) as node:
        for kind, recorder in ((SendFailed, failed), (BusLost, lost), (BusBack, back)):
            node.on(kind, recorder)
        node.set(ON, period=0.005)
        heard = frames_until(far, is_on)
        for number in (1, 2):
            rough.before_send = raising(error, times=3)
            failed.wait(number)
            back.wait(number)
            heard += rest(far)
            heard += frames_until(far, is_on)
    assert len(trailing_offs(heard + rest(far))) >= 5
    assert [event.message for event in failed.seen] == [V2B_CMD] * 2
    assert all(is_shown(event.error, error) for event in failed.seen)
    assert len(lost.seen) == len(back.seen) == 2


def test_of_send_for_good_the_node_stops_and_says_what_is_live(
    rough: RoughBus, far: can.BusABC, error: Make
) -> None:
    failed = Recorder()
    node = Node(PROTOCOL, "VCU", rough)
    node.on(SendFailed, failed)
    node.start()
    node.set(ON, period=0.005)
    frames_until(far, is_on)
    rough.before_send = raising(error)
    failed.wait()
    tried = rough.tried_to_send
    with pytest.raises(StillActingError) as raised:
        node.stop()
    assert is_shown(raised.value.cause, error)
    assert rough.tried_to_send >= tried + 5
    assert len(failed.seen) == 1


def test_of_a_checksum_one_message_is_not_sent_and_the_others_are(
    bench: Bench, near: can.BusABC, far: can.BusABC, error: Make
) -> None:
    fails = False

    def crc(data: bytes) -> int:
        if fails:
            raise error()
        return 0x5A

    failed = Recorder()
    node = bench.node("BMU", near, codec=Codec(algorithms={"BMS_CRC": crc}))
    node.on(SendFailed, failed)
    node.set(REQUEST, period=0.1)
    node.set(B2V_ST1())
    bench.run(0.5)
    fails = True
    bench.run(1.0)
    fails = False
    bench.run(1.5)
    frames = frames_on(far)
    lives = [frame.data[6] for frame in frames if frame.arbitration_id == REQUEST.FRAME_ID]
    assert lives == list(range(10))
    assert sum(frame.arbitration_id == B2V_ST1.FRAME_ID for frame in frames) == 15
    (event,) = failed.seen
    assert event.message is BMS_TMS_0
    assert is_shown(event.error, error)


def test_of_a_checksum_a_frame_is_not_handled_and_those_after_it_are(
    bench: Bench, near: can.BusABC, far: can.BusABC, error: Make
) -> None:
    fails = True

    def crc(data: bytes) -> int:
        if fails:
            raise error()
        return 0

    failed, heard = Recorder(), Recorder()
    node = bench.node("TMS", near, codec=Codec(algorithms={"BMS_CRC": crc}))
    node.on(ReceiveFailed, failed)
    node.on(BMS_TMS_0, heard)
    request = can.Message(arbitration_id=BMS_TMS_0.FRAME_ID, data=bytes(8))
    for _ in range(3):
        far.send(request)
        far.send(st2())  # is handled, and does not make the other frames news
        bench.turn()
    assert (len(failed.seen), len(heard.seen)) == (1, 0)
    assert failed.seen[0].frame_id == BMS_TMS_0.FRAME_ID
    assert is_shown(failed.seen[0].error, error)
    fails = False
    far.send(request)
    bench.turn()
    fails = True
    far.send(request)
    bench.turn()
    assert (len(failed.seen), len(heard.seen)) == (2, 1)
    assert TMS_BMS_0 in PROTOCOL.sent_by("TMS")
    assert node.counts.received == 4


def test_of_what_makes_a_message_its_cycle_is_left_out(
    bench: Bench, near: can.BusABC, far: can.BusABC, error: Make, caplog: pytest.LogCaptureFixture
) -> None:
    failed = Recorder()
    node = bench.node("VCU", near)
    node.on(SendFailed, failed)
    act = raising(error, times=4)
    node.supply(V2B_CMD, lambda: act() or [ON])
    bench.run(1.0)
    # Begun within the first 50 ms, of 20 cycles 4 are left out.
    assert len(commands(rest(far))) == 16
    (event,) = failed.seen
    assert event.message is V2B_CMD
    assert is_shown(event.error, error)
    assert len(caplog.records) == 1


def test_of_what_makes_an_answer_it_is_reported_and_the_next_is_given(
    bench: Bench, near: can.BusABC, far: can.BusABC, error: Make
) -> None:
    failed = Recorder()
    node = bench.node("VCU", near)
    node.on(SendFailed, failed)
    act = raising(error, times=1)
    node.provide_from(V2B_VIN, lambda: act() or [V2B_VIN(frame_no=1)])
    for _ in range(2):
        far.send(can.Message(arbitration_id=B2V_RQ.FRAME_ID, data=encode(B2V_RQ(vin=1))))
        bench.turn()
    assert [event.message for event in failed.seen] == [V2B_VIN]
    assert len(rest(far)) == 1


def test_of_a_callback_it_is_logged_and_the_others_are_called(
    near: can.BusABC, far: can.BusABC, error: Make, caplog: pytest.LogCaptureFixture
) -> None:
    heard = Recorder()
    with Node(PROTOCOL, "VCU", near) as node:
        node.on(B2V_ST2, raising(error))
        node.on(B2V_ST2, heard)
        node.set(ON)
        for _ in range(2):
            far.send(st2())
        heard.wait(2)
        frames = frames_until(far, is_on)
    assert is_off((frames + rest(far))[-1])
    logged = [record.exc_info for record in caplog.records]
    assert [info[0] for info in logged if info] == [type(error())] * 2


def test_of_opening_another_bus_it_is_tried_again(
    bench: Bench,
    open_bus: Callable[..., can.BusABC],
    rough: RoughBus,
    far: can.BusABC,
    error: Make,
) -> None:
    act, lost, back, heard = raising(error, times=2), Recorder(), Recorder(), Recorder()
    rough.before_recv = raising(error)
    node = bench.node("VCU", rough, reopen=lambda: act() or open_bus())
    for kind, recorder in ((BusLost, lost), (BusBack, back), (B2V_ST2, heard)):
        node.on(kind, recorder)
    bench.run(0.3)  # lost at 0, tried at 0.05, 0.15 and 0.35
    assert (len(lost.seen), len(back.seen)) == (1, 0)
    bench.run(0.4)
    assert (len(lost.seen), len(back.seen)) == (1, 1)
    far.send(st2())
    bench.turn()
    assert len(heard.seen) == 1
    node.stop()
