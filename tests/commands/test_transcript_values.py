"""Lines of frames whose signals are not there, or are floats that no JSON has."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import can
import pytest

from typedcan.commands.transcript import json_line, text_line
from typedcan.databases.dbc import read_database
from typedcan.dynamic import typed_protocol
from typedcan.wire.codec import Codec
from typedcan.wire.receiver import Received, Receiver

_DBC = """VERSION ""

BS_:

BU_: Gate Panel

BO_ 256 State: 2 Gate
 SG_ Page M : 0|8@1+ (1,0) [0|3] "" Panel
 SG_ Door m0 : 8|8@1+ (1,0) [0|255] "" Panel
 SG_ Temp m1 : 8|8@1+ (0.5,0) [0|100] "degC" Panel

BO_ 257 Flow: 8 Gate
 SG_ Now : 0|32@1- (1,0) [0|0] "l/min" Panel
 SG_ Mean : 32|32@1- (1,0) [0|0] "l/min" Panel

VAL_ 256 Door 0 "Shut" 1 "Open" ;
SIG_VALTYPE_ 257 Now : 1;
SIG_VALTYPE_ 257 Mean : 1;
"""


@pytest.fixture
def receiver(tmp_path: Path) -> Receiver:
    path = tmp_path / "gate.dbc"
    path.write_text(_DBC, "ascii")
    return Receiver(Codec(typed_protocol(read_database(path))))


def lines(receiver: Receiver, frame_id: int, data: bytes) -> tuple[str, dict[str, object]]:
    """The frame as text and as JSON."""
    frame = can.Message(arbitration_id=frame_id, is_extended_id=False, data=data, timestamp=1.0)
    received = receiver.take(frame)
    assert isinstance(received, Received)
    found: dict[str, object] = json.loads(json_line(received))
    return text_line(received), found


@pytest.mark.parametrize(
    ("data", "text", "signals"),
    [
        ("00 01", "page=0  door=Open", {"Page": 0, "Door": {"value": 1, "label": "Open"}}),
        ("01 05", "page=1  temp=2.5 degC", {"Page": 1, "Temp": 2.5}),
        ("02 05", "page=2", {"Page": 2}),
    ],
)
def test_only_the_signals_of_the_branch_that_is_there_are_printed(
    data: str, text: str, signals: dict[str, object], receiver: Receiver
) -> None:
    line, found = lines(receiver, 256, bytes.fromhex(data))
    assert line.endswith(f"State  {text}")
    assert (found["signals"], found["states"]) == (signals, {})


@pytest.mark.parametrize("value", ["nan", "inf", "-inf"])
def test_a_float_that_is_no_number_is_null_and_told_in_words(
    value: str, receiver: Receiver
) -> None:
    line, found = lines(receiver, 257, struct.pack("<ff", float(value), 0.5))
    assert line.endswith(f"Flow  now={value} l/min  mean=0.5 l/min")
    assert found["signals"] == {"Now": None, "Mean": 0.5}
    assert found["states"] == {"Now": value}
