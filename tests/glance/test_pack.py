"""The pack at a glance, and the map of its cells."""

from __future__ import annotations

import can
import pytest
from monitor.monitored import Monitored, frame, look


def ucell(csc: int, number: int, at: float, *millivolts: int) -> can.Message:
    """A frame of B2V_Ucell from three cell voltages."""
    names = ("CSCNo_UcellN", "CSCNo_UcellN1", "CSCNo_UcellN2")
    volts = {name: each / 1000 for name, each in zip(names, millivolts, strict=True)}
    return frame("B2V_Ucell", at, UC_CSCNo=csc, FrameNo=number, **volts)


def totals(at: float, cscs: int, cells: int) -> can.Message:
    """A frame of B2V_BattInfo2."""
    return frame("B2V_BattInfo2", at, TotCSCNum=cscs, TotCellNum=cells, TotTempNum=1)


def test_nothing_is_known_before_anything_came(monitored: Monitored) -> None:
    shown = look(monitored.at(0.0))
    pack = shown.pack
    items = [item for section in pack.sections for item in section.items]
    assert {(item.text, item.value, item.mark) for item in items} == {("", None, "")}
    assert shown.alarms == ()


def test_values_come_with_unit_and_label(monitored: Monitored) -> None:
    monitored.hear(
        frame("B2V_ST0", 0.0, ST_MainPos=2, ST_Prechg=1),
        frame("B2V_ST1", 0.0, BMS=2, ChgSt=1),
        frame("B2V_ST2", 0.0, SOC=76.4, Current=-100),
        frame("B2V_ST3", 0.0, Upack_Batt=600, Upack_Out=599.5),
        frame("B2V_ST4", 0.0, Max_Temp=35, MaxTemp_CSCNo=3, MaxTemp_Position=2),
    )
    pack = look(monitored.at(0.05)).pack
    texts = {
        "soc": "76.4 %",
        "main_positive": "Closed",
        "precharge": "Open",
        "hv_state": "HV closed",
        "charge_state": "Charging",
        "voltage_inside": "600 V",
        "voltage_outside": "599.5 V",
        "power": "-60.0 kW, charging",
        "hottest": "35 degC, CSC 3 no. 2",
    }
    assert {key: pack.item(key).text for key in texts} == texts
    assert (pack.item("power").value, pack.item("power").unit) == (-60.0, "kW")
    assert pack.item("hv_state").value == 2


def test_an_invalid_value_is_marked_and_gives_no_power(monitored: Monitored) -> None:
    monitored.hear(frame("B2V_ST2", 0.0, SOC=102), frame("B2V_ST3", 0.0, Upack_Batt=6553.5))
    pack = look(monitored.at(0.0)).pack
    soc = pack.item("soc")
    assert (soc.text, soc.value, soc.mark) == ("Signal Invalid", None, "invalid")
    assert pack.item("power").text == ""


def test_a_value_is_not_to_be_relied_on_once_its_message_is_lost(monitored: Monitored) -> None:
    monitored.hear(frame("B2V_ST2", 0.0, SOC=80))
    assert look(monitored.at(0.1)).pack.item("soc").mark == ""
    assert look(monitored.at(0.2)).pack.item("soc").mark == "late"
    lost = look(monitored.at(1.0)).pack.item("soc")
    assert (lost.text, lost.mark) == ("80 %", "lost")


def test_alarms_of_all_nodes_are_listed_while_they_last(monitored: Monitored) -> None:
    monitored.hear(
        frame("B2V_ST1", 1.0, Fault_Levl=2, Flt_OverTemp=2),
        frame("B2V_ST0", 1.0, Flt_MainPosRelayWeld=1),
    )
    shown = look(monitored.at(3.0))
    pack = shown.pack
    listed = [(alarm.signal, alarm.text, alarm.age) for alarm in shown.alarms]
    assert sorted(listed) == [
        ("B2V_ST0_Flt_MainPosRelayWeld", "Fault", 2.0),
        ("B2V_ST1_Flt_OverTemp", "Level 2-More severe fault", 2.0),
    ]
    assert pack.item("fault_level").text == "Level 2-More severe fault"
    monitored.hear(frame("B2V_ST1", 3.1, ALIV=1))
    assert [alarm.message for alarm in monitored.at(3.1).alarms] == ["B2V_ST0"]


def test_single_frames_make_a_partial_map(monitored: Monitored) -> None:
    monitored.hear(ucell(1, 2, 0.0, 3300, 3310, 3320))
    cells = look(monitored.at(0.0)).cells
    assert cells.groups == {1: (None, None, None, *map(pytest.approx, (3.3, 3.31, 3.32)))}
    assert (cells.received, cells.total, cells.is_complete) == (3, None, False)


def test_a_complete_set_tells_cells_from_fill(monitored: Monitored) -> None:
    invalid = 65535
    for n in range(5):
        at = n / 10
        monitored.hear(
            totals(at, 2, 8),
            ucell(1, 1, at, 3301, 3302, 3303),
            ucell(1, 2, at, 3304, invalid, invalid),
            ucell(2, 1, at, 3290, 3306, 3307),
            ucell(2, 2, at, invalid, invalid, invalid),
        )
    cells = look(monitored.at(0.5)).cells
    assert [len(group) for group in cells.groups.values()] == [4, 4]
    assert str(cells.groups[2][3]) == "Signal Invalid"
    assert (cells.received, cells.total, cells.is_complete) == (8, 8, True)
    assert cells.lowest == pytest.approx((2, 1, 3.29))
    assert cells.highest == pytest.approx((2, 3, 3.307))
    assert not look(monitored.at(2.0)).cells.is_complete


def test_another_pack_begins_with_an_empty_map(monitored: Monitored) -> None:
    monitored.hear(totals(0.0, 1, 3), ucell(1, 1, 0.0, 3300, 3300, 3300), totals(0.1, 1, 6))
    cells = look(monitored.at(0.1)).cells
    assert (cells.groups, cells.total) == ({}, 6)
