"""Which protocols have the glance at a pack: this standard, in whatever words."""

from __future__ import annotations

from argparse import Namespace
from dataclasses import replace
from pathlib import Path

import can
import pytest
from monitor.machine import CODEC
from monitor.monitored import Monitored, frame, look

from swapcan import PROTOCOL, encode
from swapcan.commands.tool import TOOL
from swapcan.glance.look import glance_of
from swapcan.transfer import split_vin
from typedcan.dynamic import typed_protocol
from typedcan.monitor.watch import Watch
from typedcan.wire.codec import Codec

CHINESE = Path(__file__).parents[2] / "dbc" / "caamtb-swap.zh-utf8.dbc"


@pytest.fixture
def chinese(tmp_path: Path) -> Codec:
    """The standard with labels of a Chinese DBC, and message classes of its own."""
    path = tmp_path / "chinese.dbc"
    text = CHINESE.read_text("utf-8").replace('"Closed"', '"闭合"')
    path.write_text(text.replace('"HV closed"', '"on\x1b[2J"'), "utf-8")
    return Codec(TOOL.protocol(Namespace(dbc=path, edition=None, reading=[])))


def test_other_protocols_have_none() -> None:
    assert glance_of(CODEC.protocol) is None
    fewer = replace(PROTOCOL.model, messages=PROTOCOL.model.messages[1:], transfers=(), requests=())
    assert glance_of(typed_protocol(fewer)) is None


def test_a_database_of_this_standard_shows_the_pack_in_its_own_words(chinese: Codec) -> None:
    assert chinese.protocol is not PROTOCOL
    monitored = Monitored(Watch(0.0, chinese, glance=glance_of(chinese.protocol)))
    vin = "LZGJL4V40MX000001"
    monitored.hear(
        frame("B2V_ST0", 0.0, ST_MainPos=2),
        frame("B2V_ST2", 0.0, SOC=76.4),
        frame("B2V_ST1", 0.0, Fault_Levl=2, Flt_OverTemp=2),
        frame("B2V_BattInfo2", 0.0, TotCSCNum=1, TotCellNum=3, TotTempNum=1),
        frame("B2V_Ucell", 0.0, UC_CSCNo=1, FrameNo=1, CSCNo_UcellN=3.3),
        *(can.Message(arbitration_id=0x18E1F3D0, data=encode(each)) for each in split_vin(vin)),
    )
    picture = monitored.at(0.05)
    shown = look(picture)
    assert shown.pack.item("soc").text == "76.4 %"
    assert shown.pack.item("main_positive").text == "闭合"
    assert shown.vin == vin
    assert (shown.cells.total, shown.cells.received) == (3, 3)
    assert [alarm.signal for alarm in picture.alarms] == ["B2V_ST1_Flt_OverTemp"]
    told = [str(each.event) for each in monitored.session.events()]
    assert f"VIN {vin}" in told


def test_the_pack_in_the_view_is_aligned_and_steers_no_terminal(chinese: Codec) -> None:
    pytest.importorskip("textual", reason="the view needs textual")
    monitored = Monitored(Watch(0.0, chinese, glance=glance_of(chinese.protocol)))
    monitored.hear(frame("B2V_ST0", 0.0, ST_MainPos=2, ST_MainNeg=1), frame("B2V_ST1", 0.0, BMS=2))
    lines: list[str] = monitored.at(0.0).look.text(99).plain.split("\n")
    assert any(r"state      on\x1b[2J" in line for line in lines)
    # Beside each other: each Chinese character takes two places of the terminal.
    (closed,) = (line for line in lines if "闭合" in line)
    (above,) = (line for line in lines if "insul. +" in line)
    before = closed[: closed.index("insul. -")]
    assert len(before) + before.count("闭") + before.count("合") == above.index("insul. +")
