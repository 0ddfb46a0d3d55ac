"""Lines of frames whose signals are not there, or are floats that no JSON has."""

from __future__ import annotations

import json
import math
import struct
from pathlib import Path

import can
import pytest

from typedcan.commands.transcript import json_line, text_line
from typedcan.databases.dbc import read_database
from typedcan.dynamic import typed_protocol
from typedcan.model.numbers import without_noise
from typedcan.wire.codec import Codec
from typedcan.wire.receiver import Received, Receiver

_DBC = """VERSION ""

BS_:

BU_: Gate Panel

BO_ 256 State: 2 Gate
 SG_ Page M : 0|8@1+ (1,0) [0|3] "" Panel
 SG_ Door m0 : 8|8@1+ (1,0) [0|255] "" Panel
 SG_ Temp m1 : 8|8@1+ (0.5,0) [0|100] "degC" Panel

BO_ 258 Dose: 8 Gate
 SG_ Small : 0|32@1+ (1E-10,0) [0|0] "g" Panel
 SG_ Steps : 32|8@1+ (0.1,0) [0|0] "g" Panel

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


@pytest.mark.parametrize("value", [1.401298464324817e-45, -3.2e-38, 0.0781609416, 16777217.5])
def test_a_float_has_all_its_digits_in_json(value: float, receiver: Receiver) -> None:
    data = struct.pack("<ff", value, 0)
    _, found = lines(receiver, 257, data)
    assert found["signals"] == {"Now": struct.unpack("<ff", data)[0], "Mean": 0.0}


def test_a_small_factor_is_seen_in_json_and_the_noise_of_arithmetic_is_not(
    receiver: Receiver,
) -> None:
    _, found = lines(receiver, 258, struct.pack("<II", 208, 3))
    assert found["signals"] == {"Small": 2.08e-8, "Steps": 0.3}


def test_noise_is_what_arithmetic_made_and_no_more() -> None:
    assert without_noise(0.1 * 3) == 0.3
    assert without_noise(24.7 * 17 - 40.0) == 379.9
    # A step of a signal of 52 bits, which is less than the 15th digit.
    assert without_noise(450359962737049.6) == 450359962737049.6
    assert math.copysign(1, without_noise(-0.0)) == -1
