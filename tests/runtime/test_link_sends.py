"""`Link.send`: bytes worked out by hand from the tables, seen by a bare python-can bus."""

from __future__ import annotations

import math
from collections.abc import Callable

import can
import pytest

from swapcan import Codec, EncodeError, Link, Message, SignalState
from swapcan.messages import (
    B2V_ST1,
    B2V_ST2,
    B2V_ST5,
    BMS_TMS_0,
    BSU_BMS_0,
    V2B_CMD,
    V2B_VIN,
    AccessoryHvCommand,
    HeatCommand,
    HvCommand,
    HvRequest,
)


def received(bus: can.BusABC) -> can.Message:
    frame = bus.recv(1.0)
    assert frame is not None
    return frame


def test_a_physical_message_goes_out_as_the_bytes_of_the_table(
    near: can.BusABC, far: can.BusABC
) -> None:
    # 80 % / 0.4 = 200; 100 % / 0.4 = 250; (-120.5 A + 1000) / 0.1 = 8795; 150 A; 300.5 A
    sent = Link(near).send(
        B2V_ST2(
            soc=80.0,
            soh=100.0,
            current=-120.5,
            max_lmt_chg_curr=150.0,
            max_lmt_dis_chg_curr=300.5,
        )
    )
    frame = received(far)
    assert frame.arbitration_id == 0x1882D0F3
    assert frame.is_extended_id
    assert not frame.is_remote_frame
    assert not frame.is_fd
    assert frame.dlc == 8
    assert frame.data.hex() == "c8fa5b22dc05bd0b"
    assert (sent.arbitration_id, sent.data) == (frame.arbitration_id, frame.data)


def test_checksum_and_counter_are_filled_in(near: can.BusABC, far: can.BusABC) -> None:
    command = V2B_CMD(
        hv_on_off=HvCommand.HV_ON,
        hv_acc_on_off=AccessoryHvCommand.HV_ACC_OFF,
        vehicle_speed=42.0,
        heat_on_off=HeatCommand.HEAT_OFF,
    )
    link = Link(near)
    link.send(command)
    link.send(command)
    # 0x90 ^ 0x2A ^ 0xFE ^ 0xFF ^ 0xFF ^ 0x3F = 0x7B; the counter flips the last bit of both
    assert received(far).data.hex() == "7b902afeffff3f00"
    assert received(far).data.hex() == "7a912afeffff3f00"


def test_what_is_left_out_goes_out_as_invalid(near: can.BusABC, far: can.BusABC) -> None:
    Link(near).send(B2V_ST5(max_ucell=SignalState.ABNORMAL, max_ucell_position=3))
    # 8190 abnormal, CSC 255 invalid, cell 3, 8191 invalid, two unused bytes
    assert received(far).data.hex() == "fe1fff03ff1f0000"


def test_the_counters_of_each_message_run_on_their_own_and_wrap(
    near: can.BusABC, far: can.BusABC
) -> None:
    link = Link(near)
    seen: dict[str, list[int]] = {"V2B_CMD": [], "BMS_TMS_0": [], "BSU_BMS_0": []}
    for _ in range(300):
        link.send(V2B_CMD())
        seen["V2B_CMD"].append(received(far).data[1] & 0x0F)
        link.send(BMS_TMS_0(reqst_tms_hv_on=HvRequest.REQUEST_HV_OFF))
        seen["BMS_TMS_0"].append(received(far).data[6])
        link.send(BSU_BMS_0())
        seen["BSU_BMS_0"].append(received(far).data[0])
    assert seen["V2B_CMD"] == [number % 15 for number in range(300)]
    assert seen["BMS_TMS_0"] == [number % 256 for number in range(300)]
    assert seen["BSU_BMS_0"] == [number % 256 for number in range(300)]


def test_a_received_message_is_forwarded_with_a_counter_and_checksum_of_its_own(
    open_bus: Callable[..., can.BusABC], near: can.BusABC, far: can.BusABC
) -> None:
    # Counter 9, BMS state 2: 0x29 ^ 0x40 = 0x69
    near.send(can.Message(arbitration_id=0x1881D0F3, data=bytes.fromhex("6929400000000000")))
    message = Link(far).receive().message
    assert isinstance(message, B2V_ST1)
    assert (message.checksum, message.aliv) == (0x69, 9)
    Link(far).send(message)
    assert received(near).data.hex() == "6020400000000000"


def test_a_checksum_that_the_standard_leaves_open_is_the_users(
    near: can.BusABC, far: can.BusABC
) -> None:
    codec = Codec(algorithms={"BMS_CRC": lambda data: sum(data) & 0xFF})
    link = Link(near, codec=codec)
    link.send(
        BMS_TMS_0(volt=0x0203, set_temp=0.0, reqst_tms_hv_on=HvRequest.REQUEST_HV_ON, crc=0x99)
    )
    assert received(far).data.hex() == "000203002800002d"  # 2 + 3 + 40
    Link(near).send(
        BMS_TMS_0(volt=0x0203, set_temp=0.0, reqst_tms_hv_on=HvRequest.REQUEST_HV_ON, crc=0x99)
    )
    assert received(far).data.hex() == "0002030028000000"


@pytest.mark.parametrize(
    ("message", "field", "problem"),
    [
        (B2V_ST2(soc=102.4), "soc", "102.4 % is out of range; allowed are 0 to 102 %"),
        (B2V_ST2(current=-1000.1), "current", "out of range"),
        (B2V_ST2(soc=102.0), "soc", "102 would be sent as raw 255, which means Signal Invalid"),
        (B2V_ST2(soc=math.nan), "soc", "nan is not a finite number"),
        (B2V_ST2(soc=math.inf), "soc", "inf is not a finite number"),
        (B2V_ST2(soc=-math.inf), "soc", "-inf is not a finite number"),
        (B2V_ST2(soc="80"), "soc", "expected a number, not '80'"),  # type: ignore[arg-type]
        (B2V_ST2(soc=SignalState.ABNORMAL), "soc", "has no code for Abnormal"),
        (B2V_ST5(max_ucell=8.19), "max_ucell", "raw 8190, which means Abnormal"),
        (V2B_CMD(hv_on_off=4), "hv_on_off", "code 4"),
        (V2B_CMD(hv_on_off="HV Onn"), "hv_on_off", "unknown label 'HV Onn'"),  # type: ignore[arg-type]
        (V2B_VIN(b1_8_15="é"), "b1_8_15", "is none of the characters"),
    ],
)
def test_a_value_that_cannot_be_sent_is_refused_and_nothing_goes_out(
    near: can.BusABC, far: can.BusABC, message: Message, field: str, problem: str
) -> None:
    with pytest.raises(EncodeError) as refused:
        Link(near).send(message)
    assert (refused.value.message, refused.value.field) == (message.NAME, field)
    assert problem in str(refused.value)
    assert far.recv(0) is None


def test_the_counter_stays_where_the_bus_refuses_a_frame(
    open_bus: Callable[..., can.BusABC], near: can.BusABC
) -> None:
    narrow = open_bus(rx_queue_size=1)
    link = Link(near)
    link.send(BSU_BMS_0(), timeout=0)
    with pytest.raises(can.CanOperationError):
        link.send(BSU_BMS_0(), timeout=0)
    assert received(narrow).data[0] == 0
    link.send(BSU_BMS_0(), timeout=0)
    assert received(narrow).data[0] == 1


def test_the_counter_stays_where_a_value_is_refused(near: can.BusABC, far: can.BusABC) -> None:
    link = Link(near)
    with pytest.raises(EncodeError):
        link.send(BSU_BMS_0(connector_temp=1000.0))
    link.send(BSU_BMS_0())
    assert received(far).data[0] == 0


def test_a_closed_bus_raises_the_error_of_python_can(near: can.BusABC) -> None:
    near.shutdown()
    with pytest.raises(can.CanOperationError):
        Link(near).send(V2B_CMD())
