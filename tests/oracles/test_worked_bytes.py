"""Payloads worked out by hand from the tables and annex A.1; the working stands beside each."""

from __future__ import annotations

import pytest

from swapcan import Message, SignalState, decode, encode
from swapcan import messages as m

WORKED: dict[str, tuple[Message, int | None, str]] = {
    # SOC 80 / 0.4 = 200 = C8; SOH 100 / 0.4 = 250 = FA;
    # current (-120.5 + 1000) / 0.1 = 8795 = 225B, low byte first;
    # 250.0 / 0.1 = 2500 = 09C4; 400.0 / 0.1 = 4000 = 0FA0.
    "state of charge and current": (
        m.B2V_ST2(
            soc=80.0,
            soh=100.0,
            current=-120.5,
            max_lmt_chg_curr=250.0,
            max_lmt_dis_chg_curr=400.0,
        ),
        None,
        "C8 FA 5B 22 C4 09 A0 0F",
    ),
    # Byte 1: counter 5, BMS state 2 << 4, accessory relay 1 << 6 = 65.
    # Byte 2: line 1, mode 1 << 1, charging 1 << 3, level 2 << 5 = 4B.
    # Byte 3: overtemperature 3 << 2 = 0C. Byte 7: fire 1 << 2, 17 faults << 3 = 8C.
    # Checksum 65 ^ 4B = 2E, ^ 0C = 22, ^ 8C = AE.
    "pack state with checksum and counter": (
        m.B2V_ST1(
            bms=m.BmsState.HV_CLOSED,
            acc_relay=m.AccessoryRelayState.CLOSED,
            chg_line=1,
            chg_mode=m.ChargeMode.DC_CHARGING,
            chg_st=m.ChargeState.CHARGING,
            fault_levl=m.FaultLevel.LEVEL_2_MORE_SEVERE_FAULT,
            flt_over_temp=m.FaultLevel.LEVEL3_MOST_SEVERE_FAULT,
            flt_fire=m.FaultFlag.FAULT,
            gbt32960_flt_num=17,
        ),
        5,
        "AE 65 4B 0C 00 00 00 8C",
    ),
    # Byte 1: counter 14, HV on 1 << 4, accessories on 1 << 6 = 5E. Byte 2: 42 = 2A.
    # Heating and all contactors are not given: 3, signal invalid, in bits 24 to 53;
    # bits 54 to 63 are reserved and 0. Checksum 5E ^ 2A = 74, ^ FF ^ FF ^ FF = 8B, ^ 3F = B4.
    "VCU command with checksum and counter": (
        m.V2B_CMD(
            hv_on_off=m.HvCommand.HV_ON,
            hv_acc_on_off=m.AccessoryHvCommand.HV_ACC_ON,
            vehicle_speed=42.0,
        ),
        14,
        "B4 5E 2A FF FF FF 3F 00",
    ),
    # Byte 1: 1 asks, 2 << 2 does not = 09, which is the checksum too: the rest is 0.
    "request for pack data": (
        m.V2B_RQData(
            rq_batt_info=m.BattInfoRequest.REQUEST_BATTINFO_DATA,
            rq_sys_code=m.SysCodeRequest.NOT_REQUEST_SYSCODE_DATA,
        ),
        None,
        "09 09 00 00 00 00 00 00",
    ),
    # Bits 0 and 1: 1 asks; bits 2 and 3 are not given: 3 << 2. 1 + 12 = 0D.
    "request for the VIN": (
        m.B2V_RQ(vin=m.VinRequest.REQUEST_VIN),
        None,
        "0D 00 00 00 00 00 00 00",
    ),
    # Byte 1: manufacturer 4 in three bits, length 24 << 3 = C4; then the ASCII codes.
    # Checksum C4 ^ 30 = F4, ^ 33 = C7, ^ 4A = 8D, ^ 50 = DD, ^ 42 = 9F, ^ 31 = AE.
    "pack code": (
        m.B2V_SysCode1(
            manufacturer=m.Manufacturer.SAMSUNG,
            sys_code_length=24,
            sys_code_b1="0",
            sys_code_b2="3",
            sys_code_b3="J",
            sys_code_b4="P",
            sys_code_b5="B",
            sys_code_b6="1",
        ),
        None,
        "AE C4 30 33 4A 50 42 31",
    ),
    # The third frame of a VIN that ends in 007: characters 15 to 17, the rest filled with 0.
    "end of a VIN": (
        m.V2B_VIN(frame_no=3, b1_8_15="0", b2_9_16="0", b3_10_17="7"),
        None,
        "03 30 30 37 00 00 00 00",
    ),
    # 35 + 50 = 85 = 55; -20 + 50 = 30 = 1E; 254 abnormal = FE; CSC 7; probe 3;
    # CSC of the minimum not given: invalid, FF; its probe has no invalid code: 0.
    "temperatures with offset -50": (
        m.B2V_ST4(
            max_temp=35.0,
            min_temp=-20.0,
            avg_temp=SignalState.ABNORMAL,
            max_temp_csc_no=7,
            max_temp_position=3,
        ),
        None,
        "55 1E FE 07 03 FF 00 00",
    ),
    # 3.301 / 0.001 = 3301 = 0CE5; CSC 18 = 12; cell 12 = 0C; abnormal 8190 = 1FFE.
    "highest cell voltage": (
        m.B2V_ST5(
            max_ucell=3.301,
            max_ucell_csc_no=18,
            max_ucell_position=12,
            avg_ucell=SignalState.ABNORMAL,
        ),
        None,
        "E5 0C 12 0C FE 1F 00 00",
    ),
    # Frame 4 of CSC 2: 3.2 V = 3200 = 0C80, 3.199 V = 3199 = 0C7F, the third cell invalid.
    "cell voltages": (
        m.B2V_Ucell(frame_no=4, csc_no=2, csc_no_ucell_n=3.2, csc_no_ucell_n1=3.199),
        None,
        "04 02 80 0C 7F 0C FF FF",
    ),
    # -50 + 50 = 0; 0 + 50 = 32; 204 + 50 = 254 = FE; the rest invalid.
    "probe temperatures": (
        m.B2V_Temp(
            frame_no=1, csc_no=1, csc_no_temp_n=-50.0, csc_no_temp_n1=0.0, csc_no_temp_n2=204.0
        ),
        None,
        "01 01 00 32 FE FF FF FF",
    ),
    # Byte 0: device 1. Bits 12 and 13: closed 2 << 4; bits 14 to 25 not given: invalid 3, so
    # byte 1 = E0, byte 2 = FF, byte 3 = 03. Byte 5: self protection 1, plug 2 << 1 = 05.
    # Bits 43 to 47 and 52 to 55 belong to nobody. Byte 6: 2 devices. Byte 7: code 7F.
    "relays and their faults": (
        m.B2V_ST0(
            rechrgeable_dev_no=1,
            st_main_pos=m.RelayState.CLOSED,
            flt_pack_self_protect=m.FaultFlag.FAULT,
            flt_chg_plug_ot=m.PlugFaultLevel.LEVEL_2_MORE_SEVERE_FAULT,
            rechrgeable_dev_num=2,
            battery_fault_no=0x7F,
        ),
        None,
        "01 E0 FF 03 00 05 02 7F",
    ),
    # 123456.7 / 0.1 = 1234567 = 12D687; 0.1 / 0.1 = 1; 6553.5 / 0.1 = FFFF, which is no code.
    "energy counters of 24 bits": (
        m.B2V_ElecEnergy(tot_chg_energy=123456.7, tot_dischg_energy=0.1, single_chg_energy=6553.5),
        None,
        "87 D6 12 01 00 00 FF FF",
    ),
    # 280 Ah = 0118; 614.4 V = 6144 = 1800; energy invalid; type 3, water cooling 3 << 4 = 33.
    "rated values": (
        m.B2V_BattInfo1(
            rate_cap=280.0,
            rate_h_volt=614.4,
            batt_type=m.BatteryType.LITHIUM_IRON_PHOSPHATE,
            cool_type=m.CoolingType.WATER_COOLING,
        ),
        None,
        "18 01 00 18 FF FF 33 00",
    ),
    # 380 V = 3800 = 0ED8; 32 A = 320 = 0140; control 2.
    "charging set points": (
        m.B2C_Charger(
            voltage_set=380.0,
            current_set=32.0,
            charge_control=m.ChargeControl.FAULT_STOP_TO_CHARGE,
        ),
        None,
        "D8 0E 40 01 02 00 00 00",
    ),
    # 379.9 V = 3799 = 0ED7; 31.9 A = 319 = 013F; too hot 1 << 1, off 1 << 4 = 12.
    "charger status": (
        m.C2B_ACStatus(
            voltage_output=379.9,
            current_output=31.9,
            charger_over_temp=m.ChargerFault.FAULT,
            charger_start=m.ChargerOperation.OFF_IN_ORDER_TO_PREVENT_BATTERY_REVERSE_CONNECTION,
        ),
        None,
        "D7 0E 3F 01 12 00 00 00",
    ),
    # Motorola. Byte 0: cooling 1, HV off 1 << 2, end of charge 2 << 4, closed 1 << 6 = 65.
    # 0x0123 V: high byte 01 in byte 1, low byte 23 in byte 2. Byte 4: 25 + 40 = 65 = 41.
    # Byte 6: counter 255. Byte 7: the CRC has no algorithm, 0.
    "request to the cooling unit": (
        m.BMS_TMS_0(
            reqst_set_tms_sts=m.ThermalMode.COOLING,
            reqst_tms_hv_on=m.HvRequest.REQUEST_HV_OFF,
            chrg_sts=m.ChargeState.END_OF_CHARGE,
            hv_rly_sts=m.HvRelayState.CLOSED,
            volt=float(0x0123),
            set_temp=25.0,
        ),
        255,
        "65 01 23 00 41 00 FF 00",
    ),
    # Byte 0: heating 2, relay closed 1 << 2 = 06. 60 + 40 = 64; -10 + 40 = 1E.
    # Bytes 3 and 4 belong to nobody. 0x1234 high byte first. Byte 7: level 2 << 6, code 15 = 95.
    "answer of the cooling unit": (
        m.TMS_BMS_0(
            work_sts=m.ThermalMode.HEATING,
            hv_rly_sts=m.HvRelayState.CLOSED,
            output_water_temp=60.0,
            input_water_temp=-10.0,
            reqst_cap=0x1234,
            fault_code=0x15,
            fault_lv=m.WarningLevel.LEVEL_2,
        ),
        None,
        "06 64 1E 00 00 12 34 95",
    ),
    # Byte 0: counter 200 = C8. Byte 1: locked 2, connected 1 << 2 = 06, bits 12 to 15 reserved.
    # Byte 2: 25 + 40 = 41. Byte 3: level 1, the rest reserved.
    "swap controller": (
        m.BSU_BMS_0(
            lock=m.LockState.LOCKED,
            connect_st=m.ConnectorState.CONNECTED,
            connector_temp=25.0,
            conctor_temp_warn=m.WarningLevel.LEVEL_1,
        ),
        200,
        "C8 06 41 01 00 00 00 00",
    ),
    # Nothing given: 255, 255, 65535 three times.
    "nothing, all of it with invalid codes": (m.B2V_ST2(), None, "FF FF FF FF FF FF FF FF"),
    # Nothing given: 8191 in 16 bits, 255, and a position without an invalid code.
    "nothing, in part with invalid codes": (m.B2V_ST6(), None, "FF 1F FF 00 00 00 00 00"),
    # Nothing given: no signal has an invalid code; 0 is the lowest value, -40 degC.
    "nothing, without invalid codes": (m.TMS_BMS_0(), None, "00 00 00 00 00 00 00 00"),
}
every_case = pytest.mark.parametrize("case", WORKED)


@every_case
def test_a_message_has_the_bytes_worked_out_by_hand(case: str) -> None:
    message, counter, expected = WORKED[case]
    assert encode(message, counter=counter).hex(" ").upper() == expected


@every_case
def test_the_bytes_worked_out_by_hand_decode_to_what_was_given(case: str) -> None:
    message, counter, expected = WORKED[case]
    decoded = decode(message.FRAME_ID, bytes.fromhex(expected))
    assert type(decoded) is type(message)
    for name in message.FIELDS:
        given, got = getattr(message, name), getattr(decoded, name)
        if isinstance(given, float):
            assert got == pytest.approx(given)
        elif given is not None:
            assert got == given
    if message.COUNTER:
        assert getattr(decoded, message.field_of(message.COUNTER.signal).name) == counter


def test_the_high_byte_of_the_voltage_comes_first() -> None:
    off = m.HvRequest.REQUEST_HV_OFF
    payload = encode(m.BMS_TMS_0(volt=float(0x0123), reqst_tms_hv_on=off))
    assert (payload[1], payload[2]) == (0x01, 0x23)


def test_the_fault_level_lies_above_the_fault_code_in_byte_7() -> None:
    assert encode(m.TMS_BMS_0(fault_lv=m.WarningLevel.LEVEL_3))[7] == 0b11_000000
    assert encode(m.TMS_BMS_0(fault_code=63))[7] == 0b00_111111
