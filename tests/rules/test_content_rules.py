"""The rules about what single signals say: wherever logs are cut, and code by code."""

from __future__ import annotations

from collections import Counter
from functools import reduce
from operator import xor
from pathlib import Path

import pytest
from rules.altered import database
from rules.in_blocks import ALL, candump, result_of

from swapcan.conform import RuleResult, judge_log, rule_of

CASES = Path(__file__).with_name("cases")

DEFINED = {
    "V2B_RD_RQBattInfo": (1, 2, 3),
    "V2B_RD_RQSysCode": (1, 2, 3),
    "B2V_BI1_BattType": range(1, 16),
    "B2V_BI1_CoolType": (1, 2, 3),
    "B2V_ST0_Flt_ChgPlugOT": (0, 1, 2),
    "B2V_S_ChargeControl": (0, 1, 2),
    "BMS_ReqstTMSHVon": (0, 1),
    "BMS_HVRlySts": (0, 1),
    "TMS_HVRlySts": (0, 1),
    "BSU_ConnectSt": (1, 2),
}
"""Signals of the standard whose value table has fewer codes than their bits."""

RESERVED = {
    **dict.fromkeys(
        (
            *("B2V_RQ_VIN", "B2V_RQ_HVOff"),
            *(f"B2V_ST0_ST_{relay}" for relay in ("MainPos", "MainNeg", "Prechg")),
            *(f"B2V_ST0_ST_Chg{side}{number}" for side in ("Pos", "Neg") for number in (1, 2)),
            *(f"V2B_CMD_{what}_OnOff" for what in ("HV", "HV_ACC", "Heat")),
            *(f"V2B_CMD_{relay}RelayST" for relay in ("MainPos", "MainNeg", "Prechg", "Att")),
            "V2B_CMD_MainMotorConST",
            *(f"V2B_CMD_AttConST{number}" for number in range(1, 5)),
        ),
        1,
    ),
    "B2V_BI1_BattType": 4,
}
"""How many codes of a signal tables 2, 3, 13 and 14 call reserved."""


def every_code(path: Path, longest: int) -> Path:
    """A log with all codes of all signals of up to so many bits; the other signals say 1."""
    lines: list[str] = []
    for message in database().messages:
        usual = {signal.name: 1 for signal in message.signals}
        for signal in message.signals:
            for code in range(1 << signal.length) if signal.length <= longest else ():
                data = message.encode(usual | {signal.name: code}, scaling=False, strict=False)
                if "Checksum" in message.signals[0].name:
                    data = bytes([reduce(xor, data[1:])]) + data[1:]
                lines.append(f"{len(lines)} can0 {message.frame_id:08X}#{data.hex()}")
    return candump(path, *lines)


def frames_by_signal(result: RuleResult) -> Counter[str]:
    """How many frames are wrong, by signal."""
    assert result.count < 1000
    frames: Counter[str] = Counter()
    for each in result.occurrences:
        frames[each.subject.signal] += each.frames
    return frames


def test_of_all_codes_of_short_signals_those_are_found_that_no_table_has(tmp_path: Path) -> None:
    result = result_of(rule_of("code-defined"), every_code(tmp_path / "codes.log", 4))
    lengths = {
        signal.name: signal.length for message in database().messages for signal in message.signals
    }
    assert frames_by_signal(result) == {
        name: (1 << lengths[name]) - len(codes) for name, codes in DEFINED.items()
    }


def test_of_all_codes_of_short_signals_those_are_found_that_are_reserved(tmp_path: Path) -> None:
    result = result_of(rule_of("code-reserved"), every_code(tmp_path / "codes.log", 4))
    assert frames_by_signal(result) == RESERVED


def test_of_all_codes_of_a_byte_those_are_found_that_leave_the_printed_range(
    tmp_path: Path,
) -> None:
    """Tables 13 and 17: 0 to 5 V with 255 for invalid, and -40 to 210 degC."""
    result = result_of(rule_of("value-range"), every_code(tmp_path / "codes.log", 8))
    volts = dict.fromkeys((f"B2V_BI2_{which}_Ucell" for which in ("Platform", "AvaiMin")), 204)
    assert frames_by_signal(result) == {
        **volts,
        "B2V_BI2_AvaiMax_Ucell": 204,
        "BSU_ConnectorTemp": 4,
    }


def test_numbers_of_frames_and_groups_begin_at_one(tmp_path: Path) -> None:
    result = result_of(rule_of("code-defined"), every_code(tmp_path / "codes.log", 8))
    numbers = {
        name: frames
        for name, frames in frames_by_signal(result).items()
        if name.endswith(("FrameNo", "CSCNo"))
    }
    assert numbers == {
        "V2B_VIN_FrameNo": 253,  # of 256, as table 15 has three
        **dict.fromkeys(("B2V_UC_FrameNo", "B2V_UC_CSCNo", "B2V_T_FrameNo", "B2V_T_CSCNo"), 1),
        **dict.fromkeys(
            (f"B2V_ST{n}_CSCNo" for n in ("4_MaxTemp", "4_MinTemp", "5_MaxUcell", "5_MinUcell")), 1
        ),
    }


def test_what_a_frame_with_a_wrong_checksum_says_is_not_judged(tmp_path: Path) -> None:
    log = candump(tmp_path / "wrong.log", "0 can0 1802F3D0#5B8000FE45440400")
    result = result_of(rule_of("code-reserved"), log)
    assert (result.examined, result.count) == (0, 0)


NOTHING = "1882D0F3#FFC8102700000000"
"""B2V_ST2 with SOC 255, Signal Invalid."""


@pytest.mark.parametrize("size", [1, 7, ALL])
def test_a_silence_is_no_invalid_signal(size: int, tmp_path: Path) -> None:
    # Twice 3.6 s with 2 s of silence in between, more than five periods of 0.1 s.
    times = [start + step * 0.4 for start in (0.0, 5.6) for step in range(10)]
    log = candump(tmp_path / "silent.log", *(f"{time} can0 {NOTHING}" for time in times))
    assert result_of(rule_of("invalid-lasting"), log, size).count == 0


def test_how_long_a_signal_may_be_invalid_can_be_set() -> None:
    limits = {"invalid-lasting.seconds": 5.4}
    log = CASES / "invalid-lasting" / "fails.log"
    result = judge_log(log, rules=[rule_of("invalid-lasting")], limits=limits).results[0]
    assert [(each.subject.signal, each.says()) for each in result.occurrences] == [
        ("B2V_ST5_Max_Ucell", "Abnormal for 5.5 s, allowed are 5.4 s")
    ]


def test_relays_that_the_other_side_measures_may_be_invalid_for_ever(tmp_path: Path) -> None:
    # V2B_CMD with all relays and contactors at 3; HV, ACC and heating are commanded off.
    data = bytes([0, 0xA0, 0, 0xFE, 0xFF, 0xFF, 0x3F, 0])
    frame = f"1802F3D0#{(bytes([reduce(xor, data)]) + data[1:]).hex()}"
    log = candump(tmp_path / "relays.log", *(f"{n * 0.2} can0 {frame}" for n in range(60)))
    result = result_of(rule_of("invalid-lasting"), log)
    assert result.examined
    assert result.count == 0
