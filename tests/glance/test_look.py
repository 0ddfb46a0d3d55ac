"""What lines and JSON have of a pack, and what is told of what came over several frames."""

from __future__ import annotations

import can
import pytest
from glance.test_pack import totals, ucell
from monitor.monitored import Monitored, frame, look

from swapcan import encode
from swapcan.transfer import split_pack_code, split_vin

VIN, CODE = "LZGJL4V40MX000001", "001PB280SWAPR1EA10000025"


def told(monitored: Monitored) -> list[str]:
    events = [str(each.event) for each in monitored.session.events()]
    return [text for text in events if "->" not in text and "not seen" not in text]


def test_the_line_that_sums_up_has_what_is_known_of_the_pack(monitored: Monitored) -> None:
    shown = look(monitored.at(0.0))
    assert (shown.name, shown.summary()) == ("pack", [])
    monitored.hear(
        frame("B2V_ST2", 0.0, SOC=76.4, Current=-100),
        frame("B2V_ST3", 0.0, Upack_Batt=600),
        frame("B2V_ST1", 0.0, BMS=2, Fault_Levl=1),
    )
    assert look(monitored.at(0.05)).summary() == [
        "SOC 76.4 %",
        "inside 600 V",
        "current -100 A",
        "state HV closed",
        "level Level 1-Light fault (alarm)",
    ]
    assert look(monitored.at(0.2)).summary()[0] == "SOC 76.4 % (late)"


def test_what_json_has_of_a_pack(monitored: Monitored) -> None:
    monitored.hear(
        frame("B2V_ST2", 0.0, SOC=102),
        frame("B2V_ST1", 0.0, BMS=2, Flt_OverTemp=2),
        totals(0.0, 1, 3),
        ucell(1, 1, 0.0, 3300, 65535, 3302),
        *(can.Message(arbitration_id=0x18E1F3D0, data=encode(each)) for each in split_vin(VIN)),
    )
    known = monitored.at(0.05).as_dict()
    assert list(known) == ["totals", "messages", "pack", "cells", "foreign"]
    pack, cells = known["pack"], known["cells"]
    assert list(pack) == ["vin", "pack_code", "items", "alarms"]
    assert (pack["vin"], pack["pack_code"]) == (VIN, "")
    assert pack["items"]["hv_state"] == {"text": "HV closed", "value": 2, "unit": "", "mark": ""}
    assert pack["items"]["soc"] == {
        "text": "Signal Invalid",
        "value": None,
        "unit": "%",
        "mark": "invalid",
    }
    (alarm,) = pack["alarms"]
    assert (alarm["signal"], alarm["text"]) == ("B2V_ST1_Flt_OverTemp", "Level 2-More severe fault")
    assert cells["volts"] == {"1": [3.3, "Signal Invalid", 3.302]}
    assert (cells["received"], cells["total"], cells["age"]) == (3, 3, pytest.approx(0.05))


def test_texts_and_problems_are_told_and_readings_are_not(monitored: Monitored) -> None:
    vin, code = split_vin(VIN), split_pack_code(CODE, 1)
    monitored.hear(
        *(can.Message(arbitration_id=each.FRAME_ID, data=encode(each)) for each in vin),
        *(can.Message(arbitration_id=each.FRAME_ID, data=encode(each)) for each in code * 2),
    )
    assert told(monitored) == [f"VIN {VIN}", f"pack code {CODE}"]
    for n in range(5):
        monitored.hear(totals(n / 10, 1, 3), ucell(1, 1, n / 10, 3300, 3301, 3302))
    assert told(monitored) == []
    first = can.Message(arbitration_id=vin[0].FRAME_ID, data=encode(vin[0]), timestamp=1.0)
    monitored.hear(first)
    monitored.at(60.0)
    (problem,) = told(monitored)
    assert problem.startswith("vin: ")
    assert "missing" in problem
