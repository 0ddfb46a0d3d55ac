"""For each rule a recording of the simulated nodes altered in one place, and what that breaks.

The recording breaks no rule. What else an alteration breaks is named beside the rule that it is
for, where one wrong thing is wrong in two ways.
"""

from __future__ import annotations

from rules.altered import (
    Alteration,
    added,
    again,
    both,
    byte,
    doubled,
    lost,
    lost_between,
    on_channel,
    paced,
    signals,
    signals_where,
    swapped,
)

PLAN = "hv_on@1.5s, ask@1s, drive@3s+7s, charge@14s+8s, hv_off@26s"
SECONDS = 30.0
CSCS = 3
"""High voltage closes at 2.5 s, the truck drives from 3 s, is charged from 15.6 s to 24.1 s, and
high voltage is open from 26.2 s on. The pack is asked at 1 s, the VCU at the beginning."""

BMU = (
    *(f"B2V_ST{number}" for number in range(7)),
    *("B2V_RQ", "B2V_Ucell", "B2V_Temp", "B2V_ElecEnergy", "B2C_Charger", "BMS_TMS_0"),
)

ANSWERS = (*(f"B2V_SysCode{number}" for number in range(1, 5)), "B2V_BattInfo1", "B2V_BattInfo2")

ALTERATIONS: dict[str, tuple[Alteration, frozenset[str]]] = {}
"""By id of the rule: the alteration, and the other rules that find it too."""


def _add(rule: str, alteration: Alteration, *others: str) -> None:
    ALTERATIONS[rule] = (alteration, frozenset(others))


# Frames
_add("frame-kind", added("TMS_BMS_0", 9.0, is_remote_frame=True, data=bytearray()))
_add("frame-length", added("B2V_ST6", 9.0, data=bytearray(7), dlc=7))
_add("identifier-priority", added("B2V_ST6", 9.0, arbitration_id=0x0C86D0F3))
_add("source-address", added("V2B_RQData", 1.0, arbitration_id=0x1801F3D0))
_add("reserved-bits", byte("BSU_BMS_0", 9.0, 7, 0x80))
_add("unassigned-bits", byte("B2V_ST6", 9.0, 7, 0x01))
_add("foreign-frames", added("B2V_ST6", 9.0, arbitration_id=0x18FEF100))
_add("error-frames", added("B2V_ST6", 9.0, is_error_frame=True))
_add("message-one-channel", added("B2V_ST6", 9.0, channel="charger"))

# Checksums and counters
_add("checksum", byte("B2V_ST1", 9.0, 7, 0x01))
_add("counter-sequence", signals("BSU_BMS_0", 9.0, BSU_Live=200))
_add("counter-allowed", signals("V2B_CMD", 9.0, V2B_CMD_ALIV=15))

# Times
_add("period-mean", paced("TMS_BMS_0", 1.2))
_add("period-jitter", paced("BSU_BMS_0", 1.0, uneven=0.03))
_add("period-gap", lost("B2V_ST6", 9.0))
_add("period-short", added("B2V_ST6", 9.0, later=0.04))
_add("node-silence", lost_between(["TMS_BMS_0"], 3.5, 13.0))
_add("event-repeated", again("B2V_RQ", 0.02, times=12, every=0.5))
_add("message-missing", lost_between(["B2V_ST4"], 0.0, SECONDS))
_add(
    "start-complete",
    both(lost_between((*BMU, *ANSWERS), 0.0, 26.5), lost_between(["B2V_ST6"], 0.0, 28.0)),
)
_add(
    "start-state",
    lost_between((*BMU, *ANSWERS), 0.0, 5.0),
)
_add(
    "relays-before-command",
    signals(
        "V2B_CMD",
        0.0,
        1.6,
        V2B_CMD_MainPosRelayST=0,
        V2B_CMD_MainNegRelayST=0,
        V2B_CMD_PrechgRelayST=0,
        V2B_CMD_AttRelayST=0,
    ),
    "code-reserved",
)
_add("bus-load", doubled("TMS_BMS_0", later=0.4), "period-mean", "period-short")

# Codes and ranges
_add("code-defined", signals("BSU_BMS_0", 9.0, BSU_ConnectSt=3))
_add("value-range", signals("B2V_BattInfo2", 1.0, B2V_BI2_Platform_Ucell=60))
_add("code-reserved", signals("V2B_CMD", 9.0, V2B_CMD_AttConST1=0))
_add("invalid-lasting", signals("B2V_ST2", 3.0, 9.0, B2V_ST2_SOH=255))

# Requests
_add(
    "answer-in-time",
    both(
        lost("B2V_BattInfo1", 1.0),
        signals("V2B_RQData", 1.05, SECONDS, V2B_RD_RQBattInfo=1),
    ),
)
_add("answer-unasked", added("B2V_BattInfo1", 1.0, timestamp=20.0))
_add("request-withdrawn", signals("V2B_RQData", 2.06, V2B_RD_RQSysCode=1))

# Transfers
_add("vin-transfer", lost("V2B_VIN", 0.003))
_add("vin-characters", byte("V2B_VIN", 0.003, 3, 0x80))
_add("vin-letters", signals("V2B_VIN", 0.0, V2B_VIN_B2_9_16=ord("O")))
_add("vin-check-digit", signals("V2B_VIN", 0.003, V2B_VIN_B2_9_16=ord("1")))
_add("pack-code-transfer", lost("B2V_SysCode3", 1.0))
_add("pack-code-characters", signals("B2V_SysCode2", 1.0, 3.0, B2V_SC2_SysCode_B9=ord("-")))
_add("pack-code-length", signals("B2V_SysCode1", 1.0, 3.0, B2V_SC1_SysCodeLength=20))
_add("pack-code-constant", signals("B2V_SysCode2", 1.5, 3.0, B2V_SC2_SysCode_B9=ord("Z")))
_add("cells-complete", lost("B2V_Ucell", 9.0), "period-gap")
_add("cells-order", swapped("B2V_Ucell", 9.0))
_add("probes-complete", lost("B2V_Temp", 9.0), "period-gap")
_add("probes-order", swapped("B2V_Temp", 9.0))
_add(
    "frame-numbers",
    signals("B2V_Ucell", 9.0, B2V_UC_FrameNo=0),
    *("cells-complete", "code-defined", "period-gap"),
)

# What a pack says of itself
_add("cell-voltages-ordered", signals("B2V_ST5", 9.0, B2V_ST5_Avg_Ucell=4000))
_add("cell-extremes-equal", signals("B2V_ST5", 5.0, 6.0, B2V_ST5_Max_Ucell=3900))
_add("cell-extremes-place", signals("B2V_ST6", 5.0, 6.0, B2V_ST5_MinUcell_CSCNo=9))
_add("temperatures-ordered", signals("B2V_ST4", 9.0, B2V_ST4_Avg_Temp=120))
_add("temperature-extremes-equal", signals("B2V_ST4", 5.0, 6.0, B2V_ST4_Max_Temp=100))
_add("temperature-extremes-place", signals("B2V_ST4", 5.0, 6.0, B2V_ST4_MinTemp_CSCNo=9))
_add("cell-count-announced", signals("B2V_BattInfo2", 1.0, B2V_BI2_TotCellNum=30))
_add("probe-count-announced", signals("B2V_BattInfo2", 1.0, B2V_BI2_TotTempNum=11))
_add(
    "totals-constant",
    both(
        added("B2V_BattInfo1", 1.0, later=0.1),
        signals("B2V_BattInfo1", 1.15, B2V_BI1_RateCap=100),
    ),
)
_add(
    "reading-missing",
    signals_where(
        {"B2V_UC_CSCNo": 2, "B2V_UC_FrameNo": 1},
        "B2V_Ucell",
        5.0,
        12.0,
        B2V_UC_CSCNo_UcellN=0xFFFF,
    ),
)
_add(
    "voltage-is-sum",
    signals("B2V_ST3", 5.0, 6.0, B2V_ST3_Upack_Batt=1000, B2V_ST3_Upack_Out=1000),
)
_add("soc-continuous", signals("B2V_ST2", 9.0, B2V_ST2_SOC=150))
_add("energy-counters-rise", signals("B2V_ElecEnergy", 9.0, B2V_TotDischgEnergy=1000))
_add("alarm-level-highest", signals("B2V_ST1", 9.0, B2V_ST1_Fault_Levl=2))
_add("fault-count", signals("B2V_ST1", 9.0, B2V_ST1_GBT32960FltNum=3))

# High voltage
_add("hv-only-on-command", signals("V2B_CMD", 1.4, 2.0, V2B_CMD_HV_OnOff=2))
_add("hv-on-in-time", signals("V2B_CMD", 27.0, SECONDS, V2B_CMD_HV_OnOff=1))
_add(
    "precharge-first",
    both(
        signals("B2V_ST0", 1.5, 2.7, B2V_ST0_ST_Prechg=1),
        signals("B2V_ST1", 1.6, 2.5, B2V_ST1_BMS=0),
    ),
    "hv-state-order",
)
_add("precharge-in-time", signals("B2V_ST1", 1.7, 12.5, B2V_ST1_BMS=1))
_add("hv-state-order", signals("B2V_ST1", 1.6, 2.5, B2V_ST1_BMS=0))
_add("hv-closed-relays", signals("B2V_ST0", 5.0, 6.0, B2V_ST0_ST_MainNeg=1))
_add("bus-voltage-follows", signals("B2V_ST3", 5.0, 6.0, B2V_ST3_Upack_Out=0))
_add("hv-off-in-time", signals("V2B_CMD", 8.0, 14.0, V2B_CMD_HV_OnOff=2))
_add(
    "hv-off-requested",
    both(
        added("B2V_RQ", 0.02, timestamp=5.0),
        signals("B2V_RQ", 4.0, B2V_RQ_HVOff=1),
    ),
    "hv-off-asked",
)
_add(
    "drive-ends-on-alarm",
    signals("B2V_ST1", 3.5, 10.0, B2V_ST1_Fault_Levl=3),
    "alarm-level-highest",
)
_add("discharge-limit", signals("B2V_ST2", 4.0, 7.0, B2V_ST2_MaxLmt_DisChgCurr=0))
_add(
    "feedback-limit",
    signals("B2V_ST2", 4.0, 7.0, B2V_ST2_Current=8000, B2V_ST2_MaxLmt_ChgCurr=100),
)

# Charging
_add("charger-own-bus", on_channel("C2B_ACStatus", "vehicle"))
_add("charge-line-connected", signals("B2V_ST1", 18.0, B2V_ST1_ChgLine=0))
_add("charge-current-sign", signals("B2V_ST2", 17.0, 20.0, B2V_ST2_Current=10800))
_add("charger-voltage-limit", signals("C2B_ACStatus", 17.0, 21.0, C2B_N_VoltageOutput=3000))
_add("charger-current-limit", signals("C2B_ACStatus", 17.0, 21.0, C2B_N_CurrentOutput=2000))
_add("charger-stops", signals("B2C_Charger", 17.0, 24.0, B2V_S_ChargeControl=1))
_add(
    "charge-stops-on-fault",
    signals("C2B_ACStatus", 17.0, 22.0, C2B_F_ChargerHardware=1),
    "charger-fault-told",
)
_add(
    "charge-limited-when-hot",
    signals("C2B_ACStatus", 16.3, 23.5, C2B_F_ChargerOverTemp=1),
    "charger-fault-told",
)

# The cooling unit, and the swap controller
_add("charge-states-agree", signals("BMS_TMS_0", 5.0, 9.0, BMS_ChrgSts=2))
_add("cooling-told-voltage", signals("BMS_TMS_0", 5.0, 9.0, BMS_Volt=200))
_add("cooling-told-relays", signals("BMS_TMS_0", 5.0, 9.0, BMS_HVRlySts=0))
_add("cooling-mode-followed", signals("TMS_BMS_0", 5.0, 13.0, TMS_WorkSts=1))
_add("cooling-voltage-asked", signals("TMS_BMS_0", 5.0, 10.0, TMS_HVRlySts=1))
_add("lock-while-voltage", signals("BSU_BMS_0", 5.0, 6.0, BSU_Lock=1))

# What nodes tell
_add("alarm-raised", signals("B2V_ST1", 9.0, B2V_ST1_Flt_Fog=1, B2V_ST1_Fault_Levl=1))
_add("hv-on-failed", signals("B2V_ST1", 29.5, SECONDS, B2V_ST1_BMS=3))
_add(
    "hv-off-asked",
    both(
        added("B2V_RQ", 0.02, timestamp=27.0),
        signals("B2V_RQ", 26.5, B2V_RQ_HVOff=1),
    ),
)
_add("charger-fault-told", signals("C2B_ACStatus", 17.0, C2B_F_ChargerOverTemp=1))
_add("cooling-fault-told", signals("TMS_BMS_0", 9.0, TMS_FaultLv=1))
_add("connector-warning-told", signals("BSU_BMS_0", 9.0, BSU_ConctorTempWarn=1))
