"""Values over several frames, of protocols that have no glance of their own."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import can
import pytest
from monitor.monitored import Monitored
from monitor.monitored import frame as pack_frame

from dbcspec.config import find_config
from dbcspec.project import load
from swapcan import Codec as PackCodec
from typedcan.dynamic import typed_protocol
from typedcan.model.protocol import Protocol
from typedcan.monitor.watch import Watch
from typedcan.wire.codec import Codec

SECOND = Path(__file__).parents[1] / "fixtures" / "second"


@pytest.fixture(scope="module")
def second() -> Protocol:
    """A protocol of 11 bits with a serial number in two frames."""
    return load(find_config(SECOND)).protocol


def serial(text: bytes, at: float) -> list[can.Message]:
    """Its frames: the number of each, from 1, then two characters."""
    return [
        can.Message(
            arbitration_id=0x102,
            is_extended_id=False,
            data=bytes([1 + start // 2]) + text[start : start + 2] + bytes(5),
            timestamp=at,
        )
        for start in range(0, len(text), 2)
    ]


def watching(protocol: Protocol) -> Monitored:
    return Monitored(Watch(0.0, Codec(typed_protocol(protocol))))


def shown(monitored: Monitored, at: float) -> dict[str, Any]:
    transfers: dict[str, Any] = monitored.at(at).as_dict()["transfers"]
    return transfers


def texts(monitored: Monitored) -> list[str]:
    return [str(each.event) for each in monitored.session.events()]


def view(monitored: Monitored, at: float, width: int) -> list[str]:
    pytest.importorskip("textual", reason="the view needs textual")
    text: str = monitored.at(at).look.text(width).plain
    return text.split("\n")


def test_a_text_is_told_and_shown_once_it_came_twice(second: Protocol) -> None:
    monitored = watching(second)
    monitored.hear(*serial(b"A7K2", 0.0))
    assert shown(monitored, 0.1) == {}
    assert (monitored.at(0.1).look.name, monitored.at(0.1).look.summary()) == ("overview", [])
    assert view(monitored, 0.1, 80) == [""]
    monitored.hear(*serial(b"A7K2", 0.2))
    assert "Serial number: A7K2" in texts(monitored)
    assert shown(monitored, 1.0) == {
        "serial": {"title": "Serial number", "text": "A7K2", "age": pytest.approx(0.8)}
    }
    assert view(monitored, 1.0, 80) == ["Serial number: A7K2, 0.80 s ago"]
    assert view(monitored, 1.0, 16) == ["Serial number: …"]


def test_a_text_that_is_not_completed_is_told_and_nothing_is_shown(second: Protocol) -> None:
    monitored = watching(second)
    monitored.hear(serial(b"A7K2", 0.0)[0])
    monitored.at(60.0)
    assert any(text.startswith("serial: ") and "missing" in text for text in texts(monitored))
    assert shown(monitored, 60.0) == {}


def test_what_a_terminal_would_obey_in_a_title_is_shown(second: Protocol) -> None:
    (transfer,) = second.transfers
    hostile = replace(transfer, english="Serial\x1b[2J")
    monitored = watching(replace(second, transfers=(hostile,)))
    monitored.hear(*serial(b"A7K2", 0.0), *serial(b"A7K2", 0.1))
    assert view(monitored, 0.1, 80) == [r"Serial\x1b[2J: A7K2, 0.00 s ago"]


def test_numbered_blocks_are_shown_with_their_items(second: Protocol) -> None:
    (transfer,) = second.transfers
    blocks = replace(transfer, kind="numbered_blocks", english="")
    monitored = watching(replace(second, transfers=(blocks,)))
    monitored.hear(*serial(b"\1\2\3\4", 0.0), *serial(b"\1\2\3\4", 0.1))
    assert "serial: 4 items" in texts(monitored)
    assert shown(monitored, 0.1)["serial"] == {"title": "serial", "items": [1, 2, 3, 4], "age": 0}


def test_readings_are_shown_by_group_and_not_told_each_time() -> None:
    monitored = Monitored(Watch(0.0, PackCodec()))
    names = ("CSCNo_UcellN", "CSCNo_UcellN1", "CSCNo_UcellN2")
    invalid = 65.535
    for n in range(5):
        at = n / 10
        monitored.hear(pack_frame("B2V_BattInfo2", at, TotCSCNum=2, TotCellNum=4, TotTempNum=1))
        for csc, volts in ((1, (3.3, 3.301, invalid)), (2, (invalid, 3.311, invalid))):
            values = dict(zip(names, volts, strict=True))
            monitored.hear(pack_frame("B2V_Ucell", at, UC_CSCNo=csc, FrameNo=1, **values))
    cells = shown(monitored, 0.5)["cell_voltages"]
    assert cells["groups"] == {
        "1": [pytest.approx(3.3), pytest.approx(3.301)],
        "2": ["Signal Invalid", pytest.approx(3.311)],
    }
    assert cells["age"] == pytest.approx(0.1)
    shown_lines = view(monitored, 0.5, 80)
    assert "Cell voltages of every CSC: 4 readings of 2 groups, 0.10 s ago" in shown_lines
    assert not any("readings" in text for text in texts(monitored))
