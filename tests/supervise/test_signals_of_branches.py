"""Signals of a multiplexed message: what a frame without their branch leaves as it was."""

from __future__ import annotations

from pathlib import Path

import can
import pytest

from typedcan.databases.dbc import read_database
from typedcan.dynamic import typed_protocol
from typedcan.supervise import SignalChanged, Supervisor
from typedcan.wire.codec import Codec
from typedcan.wire.receiver import Received, Receiver

_DBC = """VERSION ""

BS_:

BU_: Gate Panel

BO_ 256 State: 3 Gate
 SG_ Page M : 0|8@1+ (1,0) [0|3] "" Panel
 SG_ Door m0 : 8|8@1+ (1,0) [0|255] "" Panel
 SG_ Temp m1 : 8|8@1+ (0.5,0) [0|50] "degC" Panel
 SG_ Deep m2M : 8|8@1+ (1,0) [0|255] "" Panel
 SG_ Lock m7 : 16|8@1+ (1,0) [0|255] "" Panel

SG_MUL_VAL_ 256 Deep Page 2-2;
SG_MUL_VAL_ 256 Lock Deep 7-7;
SG_MUL_VAL_ 256 Door Page 0-0;
SG_MUL_VAL_ 256 Temp Page 1-1;
VAL_ 256 Door 0 "Normal" 1 "Broken" ;
VAL_ 256 Lock 0 "Normal" 1 "Stuck" ;
"""


@pytest.fixture
def codec(tmp_path: Path) -> Codec:
    path = tmp_path / "gate.dbc"
    path.write_text(_DBC, "ascii")
    return Codec(typed_protocol(read_database(path)))


def told(codec: Codec, *payloads: str) -> list[list[str]]:
    """What is said of signals with each payload."""
    receiver, supervisor = Receiver(codec), Supervisor(codec.protocol, "Panel")
    lines = []
    for n, payload in enumerate(payloads):
        data = bytes.fromhex(payload)
        frame = can.Message(arbitration_id=256, is_extended_id=False, data=data)
        received = receiver.take(frame)
        assert isinstance(received, Received)
        events = supervisor.take(received, float(n))
        lines.append([str(event) for event in events if isinstance(event, SignalChanged)])
    return lines


def test_an_alarm_lasts_until_its_own_branch_takes_it_back(codec: Codec) -> None:
    assert told(codec, "00 01 00", "01 02 00", "00 01 00", "01 00 00", "00 00 00") == [
        ["State.door: alarm: Broken"],
        [],
        [],
        [],
        ["State.door: no longer alarm: Normal"],
    ]


def test_bits_of_another_branch_are_not_taken_for_a_signal(codec: Codec) -> None:
    # 1 as a temperature is no broken door, and 200 as a door is no temperature.
    assert told(codec, "01 01 00", "01 C8 00", "00 C8 00", "02 01 01") == [
        [],
        ["State.temp: out of range: 100 degC"],
        ["State.door: unknown code: 200"],
        [],
    ]


def test_a_branch_in_a_branch_is_watched_too(codec: Codec) -> None:
    assert told(codec, "02 06 01", "02 07 01", "01 07 00", "02 06 00", "02 07 00") == [
        [],
        ["State.lock: alarm: Stuck"],
        [],
        [],
        ["State.lock: no longer alarm: Normal"],
    ]
