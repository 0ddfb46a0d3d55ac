"""The simulated pack as the VCU sees it: messages, high voltage, requests."""

from __future__ import annotations

import itertools
from dataclasses import replace

import can
import pytest
from nodes.bmu_talk import OFF, ON, Pack, number, relays, states
from nodes.outside import Outside

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import (
    B2V_RQ,
    B2V_ST0,
    B2V_ST1,
    B2V_ST2,
    B2V_ST3,
    B2V_ST4,
    B2V_ST5,
    B2V_ST6,
    BMS_TMS_0,
    V2B_CMD,
    AccessoryRelayState,
    B2V_BattInfo1,
    B2V_BattInfo2,
    B2V_SysCode1,
    B2V_SysCode2,
    B2V_SysCode3,
    B2V_SysCode4,
    BatteryType,
    BattInfoRequest,
    BmsState,
    CoolingType,
    HvCommand,
    Manufacturer,
    RelayState,
    SysCodeRequest,
    V2B_RQData,
    VinRequest,
)
from swapcan.nodes.status import PACK_CODE
from swapcan.transfer import split_vin
from swapcan.wire import encode
from typedcan.model.signal_state import SignalState
from typedcan.wire.message import Message

VIN = "LDEMTRCK0R0000025"


def test_it_sends_what_the_standard_asks_for_at_its_periods(pack: Pack) -> None:
    _, vcu, _ = pack
    vcu.run(20.0)
    for kind in PROTOCOL.sent_by("BMU"):
        if kind.PERIOD is None or kind in PROTOCOL.conditional:
            continue
        times = vcu.times(kind)
        frames = {"B2V_Ucell": 8, "B2V_Temp": 2}.get(kind.NAME, 1)
        assert len(times) == pytest.approx(20.0 / kind.PERIOD * frames, abs=frames + 1), kind.NAME
        mean = (times[-1] - times[0]) / (len(times) - 1) * frames
        assert mean == pytest.approx(kind.PERIOD, rel=0.02), kind.NAME
    assert vcu.faults == []


def test_no_answer_is_sent_unasked(pack: Pack) -> None:
    _, vcu, _ = pack
    vcu.run(5.0)
    assert not [message for _, message in vcu.heard if type(message) in PROTOCOL.conditional]


def test_every_status_has_a_valid_value_in_every_signal(closed: Pack) -> None:
    _, vcu, _ = closed
    for kind in (B2V_ST0, B2V_ST1, B2V_ST2, B2V_ST3, B2V_ST4, B2V_ST5, B2V_ST6, BMS_TMS_0):
        message = vcu.last(kind)
        invalid = [name for name in kind.FIELDS if is_invalid(message, name)]
        assert invalid == [], kind.NAME


def is_invalid(message: Message, name: str) -> bool:
    value = getattr(message, name)
    field = message.FIELDS[name]
    # 0 is "Reserved" for relays: neither open nor closed.
    reserved = isinstance(value, RelayState) and value is RelayState.RESERVED
    return isinstance(value, SignalState) or reserved or field.text(value) == "Signal Invalid"


def test_high_voltage_on_shows_precharge_and_then_closed_relays(pack: Pack) -> None:
    _, vcu, _ = pack
    vcu.run(0.5)
    vcu.say(ON)
    vcu.run(2.5)
    assert states(vcu) == [BmsState.HV_OPEN, BmsState.PRECHARGE, BmsState.HV_CLOSED]
    assert relays(vcu.last(B2V_ST0)) == (RelayState.CLOSED, RelayState.CLOSED, RelayState.OPEN)
    assert vcu.last(B2V_ST1).acc_relay is AccessoryRelayState.CLOSED
    main_positive = [message.st_main_pos for message in vcu.all(B2V_ST0)]
    precharge = [message.st_prechg for message in vcu.all(B2V_ST0)]
    assert precharge.index(RelayState.CLOSED) < main_positive.index(RelayState.CLOSED)
    last = vcu.last(B2V_ST3)
    assert last.upack_out == last.upack_batt


def test_the_output_voltage_rises_during_precharge(pack: Pack) -> None:
    _, vcu, _ = pack
    vcu.say(ON)
    vcu.run(1.0)
    rising = [number(message.upack_out) for message in vcu.all(B2V_ST3)]
    assert rising[0] == 0.0
    assert sum(b > a for a, b in itertools.pairwise(rising)) >= 8
    assert rising == sorted(rising)


def test_high_voltage_off_opens_the_relays(closed: Pack) -> None:
    _, vcu, _ = closed
    vcu.say(OFF)
    vcu.run(4.0)
    assert states(vcu)[-2:] == [BmsState.HV_CLOSED, BmsState.HV_OPEN]
    assert relays(vcu.last(B2V_ST0)) == (RelayState.OPEN,) * 3
    assert vcu.last(B2V_ST1).acc_relay is AccessoryRelayState.OPEN
    assert number(vcu.last(B2V_ST3).upack_out) < 1


def test_a_command_whose_counter_stands_still_is_not_obeyed(pack: Pack) -> None:
    _, vcu, _ = pack
    # The first of them is fresh, and a precharge begins; it is broken off as the command gets old.
    send_raw(vcu, encode(ON, counter=3), times=40)
    assert states(vcu) == [BmsState.HV_OPEN, BmsState.PRECHARGE, BmsState.HV_OPEN]


def test_a_command_with_a_wrong_checksum_is_not_obeyed(pack: Pack) -> None:
    _, vcu, _ = pack
    data = bytearray(encode(ON, counter=3))
    data[0] ^= 0xFF
    send_raw(vcu, bytes(data), times=40)
    assert states(vcu) == [BmsState.HV_OPEN]


def send_raw(vcu: Outside, data: bytes, *, times: int) -> None:
    """Send the same bytes as V2B_CMD, every 50 ms."""
    for _ in range(times):
        vcu._bus.send(can.Message(arbitration_id=V2B_CMD.FRAME_ID, data=data))
        vcu.run(0.05)


def test_an_invalid_command_changes_nothing(closed: Pack) -> None:
    _, vcu, _ = closed
    vcu.say(replace(ON, hv_on_off=HvCommand.SIGNAL_INVALID))
    vcu.run(3.0)
    assert vcu.last(B2V_ST1).bms is BmsState.HV_CLOSED


def test_a_silent_vcu_gets_no_high_voltage(pack: Pack) -> None:
    _, vcu, _ = pack
    vcu.say(ON)
    vcu.run(0.5)
    vcu.hush(V2B_CMD)
    vcu.run(3.0)
    assert states(vcu)[-1] is BmsState.HV_OPEN


def test_the_vin_is_asked_for_until_it_is_known_and_then_never_again(pack: Pack) -> None:
    bmu, vcu, _ = pack
    vcu.run(1.0)
    assert [message.vin for message in vcu.all(B2V_RQ)] == [VinRequest.REQUEST_VIN]
    vcu.run(5.0)
    assert [message.vin for message in vcu.all(B2V_RQ)] == [VinRequest.REQUEST_VIN] * 2
    for frame in split_vin(VIN):
        vcu._link.send(frame)
    vcu.run(20.0)
    assert bmu.vin == VIN
    asked = [message.vin for message in vcu.all(B2V_RQ)]
    assert asked == [VinRequest.REQUEST_VIN] * 2 + [VinRequest.NO_REQUEST_VIN]


def test_the_pack_code_comes_when_it_is_asked_for(pack: Pack) -> None:
    _, vcu, _ = pack
    vcu.say(
        V2B_RQData(
            rq_sys_code=SysCodeRequest.REQUEST_SYSCODE_DATA,
            rq_batt_info=BattInfoRequest.NOT_REQUEST_BATTINFO_DATA,
        )
    )
    vcu.run(1.5)
    first = vcu.last(B2V_SysCode1)
    assert first.manufacturer is Manufacturer.CATL
    assert first.sys_code_length == 24
    code = [
        getattr(vcu.last(kind), name)
        for kind in (B2V_SysCode1, B2V_SysCode2, B2V_SysCode3, B2V_SysCode4)
        for name in kind.FIELDS
        if name.startswith("sys_code_b")
    ]
    assert code == [*PACK_CODE, 0, 0, 0]
    assert not vcu.all(B2V_BattInfo1)


def test_the_battery_info_says_what_the_pack_is(pack: Pack) -> None:
    _, vcu, _ = pack
    vcu.say(
        V2B_RQData(
            rq_sys_code=SysCodeRequest.NOT_REQUEST_SYSCODE_DATA,
            rq_batt_info=BattInfoRequest.REQUEST_BATTINFO_DATA,
        )
    )
    vcu.run(0.5)
    # 24 cells of 3.2 V and 280 Ah: 76.8 V, 21.5 kWh.
    first, second = vcu.last(B2V_BattInfo1), vcu.last(B2V_BattInfo2)
    rated = (first.rate_cap, first.rate_h_volt, first.rate_power)
    assert rated == pytest.approx((280.0, 76.8, 21.5))
    assert first.batt_type is BatteryType.LITHIUM_IRON_PHOSPHATE
    assert first.cool_type is CoolingType.WATER_COOLING
    assert (second.tot_csc_num, second.tot_cell_num, second.tot_temp_num) == (2, 24, 12)
    cell = (second.platform_ucell, second.avai_min_ucell, second.avai_max_ucell)
    assert cell == pytest.approx((3.2, 2.5, 3.6))
