"""Leaving ends every message that acts with its own safe codes, and sends no other."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import can
import pytest
from node.bench import Bench, at_rest, frames_on
from node.rough_bus import (
    RoughBus,
    commands,
    frames_until,
    is_off,
    is_on,
    raising,
    rest,
    signals,
    trailing_offs,
)

from swapcan import encode
from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import (
    B2V_RQ,
    B2V_ST2,
    BMS_TMS_0,
    V2B_CMD,
    B2C_Charger,
    ChargeControl,
    HvCommand,
    HvRequest,
    ThermalMode,
)
from swapcan.node import Node
from typedcan.wire.message import Message
from typedcan.wire.protocol import FieldRef, Request

ON = V2B_CMD(hv_on_off=HvCommand.HV_ON)


def test_an_answer_that_acts_is_ended_too(near: can.BusABC, far: can.BusABC) -> None:
    asks = Request(field=FieldRef(B2V_RQ, "vin"), code=1, withdraw=2, answers=(V2B_CMD,))
    protocol = dataclasses.replace(PROTOCOL, requests=(asks,))
    with Node(protocol, "VCU", near) as node:
        node.provide(ON)
        far.send(can.Message(arbitration_id=B2V_RQ.FRAME_ID, data=encode(B2V_RQ(vin=1))))
        heard = frames_until(far, is_on)
    assert len(trailing_offs(heard + rest(far))) >= 5


def test_what_still_waits_to_go_out_once_is_not_turned_on_in_the_end(
    bench: Bench, near: can.BusABC, far: can.BusABC, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(V2B_CMD, "PERIOD", None)
    node = bench.node("VCU", near)
    node.set(ON)
    node.stop()
    assert rest(far) == []
    node.set(ON)
    node.turn()
    assert is_on(rest(far)[-1])  # by hand it goes on as before
    with Node(PROTOCOL, "VCU", near) as live:
        live.set(ON)
    assert all(map(is_off, rest(far)[-5:]))


def test_every_message_that_acts_is_ended_with_its_own_codes(
    near: can.BusABC, far: can.BusABC
) -> None:
    acting: dict[type[Message], Message] = {
        B2C_Charger: B2C_Charger(charge_control=ChargeControl.START_TO_CHARGE, current_set=50.0),
        BMS_TMS_0: BMS_TMS_0(
            reqst_tms_hv_on=HvRequest.REQUEST_HV_ON, reqst_set_tms_sts=ThermalMode.COOLING
        ),
    }
    safe: dict[type[Message], dict[str, int]] = {
        B2C_Charger: {"B2V_S_ChargeControl": 1},
        BMS_TMS_0: {"BMS_ReqstTMSHVon": 1, "BMS_ReqstSetTMSts": 0},
    }
    wanted = {kind.FRAME_ID for kind in acting}

    def has_come(frame: can.Message) -> bool:
        wanted.discard(frame.arbitration_id)
        return not wanted

    with Node(PROTOCOL, "BMU", near) as node:
        for message in acting.values():
            node.set(message, period=0.05)
        heard = frames_until(far, has_come)
    heard += rest(far)
    for kind, codes in safe.items():
        frames = [frame for frame in heard if frame.arbitration_id == kind.FRAME_ID]
        for frame in frames[-5:]:
            assert {name: signals(frame)[name] for name in codes} == codes
    lives = [frame.data[6] for frame in heard if frame.arbitration_id == BMS_TMS_0.FRAME_ID]
    assert lives == list(range(len(lives)))
    assert signals(heard[-1]).get("B2C_S_CurrentSet", 50 * 10) == 50 * 10


def test_safe_codes_can_be_sent_at_any_time_and_cycles_go_on(
    bench: Bench, rough: RoughBus, far: can.BusABC
) -> None:
    node = bench.node("VCU", rough)
    assert node.send_safe_codes() is None
    assert rest(far) == []
    node.set(ON)
    bench.run(0.1)
    assert is_on(rest(far)[-1])
    assert node.send_safe_codes() is None
    (frame,) = rest(far)
    assert is_off(frame)
    assert [*node.acting] == []
    bench.run(0.2)
    assert is_on(rest(far)[-1])
    assert [*node.acting] == [ON]
    rough.before_send = raising(lambda: OSError("Network is down"))
    failure = node.send_safe_codes()
    assert isinstance(failure, OSError)
    assert [*node.acting] == [ON]
    rough.before_send = raising(KeyboardInterrupt, times=1)
    with pytest.raises(KeyboardInterrupt):
        node.send_safe_codes()


def test_two_nodes_end_what_each_has_commanded(
    open_bus: Callable[..., can.BusABC], far: can.BusABC
) -> None:
    charge = B2C_Charger(charge_control=ChargeControl.START_TO_CHARGE)
    with Node(PROTOCOL, "VCU", open_bus()) as vcu, Node(PROTOCOL, "BMU", open_bus()) as bmu:
        vcu.set(ON)
        bmu.set(charge)
        heard = frames_until(far, lambda frame: frame.arbitration_id == charge.FRAME_ID)
        heard += frames_until(far, lambda frame: frame.arbitration_id == V2B_CMD.FRAME_ID)
    heard += rest(far)
    assert len(trailing_offs(heard)) >= 5
    chargers = [frame for frame in heard if frame.arbitration_id == charge.FRAME_ID]
    assert [signals(frame)["B2V_S_ChargeControl"] for frame in chargers[-5:]] == [1] * 5


@pytest.mark.parametrize("kind", [B2V_ST2, B2V_RQ])
def test_what_does_not_act_is_not_sent_once_more(
    near: can.BusABC, far: can.BusABC, kind: type[Message]
) -> None:
    with Node(PROTOCOL, "BMU", near) as node:
        node.send(at_rest(kind))
        node.send(at_rest(B2C_Charger))
    assert len(frames_on(far)) == 2
    assert commands(frames_on(far)) == []
