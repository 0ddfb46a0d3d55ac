"""Signals with a sign, floats, very long ones: what is out of range is told, and nothing else."""

from __future__ import annotations

import math
import struct
from pathlib import Path

import can
import pytest

from typedcan.databases.dbc import read_database
from typedcan.dynamic import typed_protocol
from typedcan.supervise import Supervisor
from typedcan.wire.codec import Codec
from typedcan.wire.receiver import Received, Receiver

_DBC = """VERSION ""

BS_:

BU_: Pump Panel

BO_ 256 State: {length} Pump
 SG_ Value : 0|{bits}@1{sign} ({factor},0) [{low}|{high}] "{unit}" Panel

{kind}
"""


def told(folder: Path, payloads: list[bytes], **signal: object) -> list[bool]:
    """Of each payload, whether it is said to be out of range."""
    facts = {"bits": 8 * len(payloads[0]), "factor": 1, "unit": "", "kind": "", **signal}
    path = folder / "pump.dbc"
    path.write_text(_DBC.format(length=len(payloads[0]), **facts), "ascii")
    codec = Codec(typed_protocol(read_database(path)))
    receiver, supervisor = Receiver(codec), Supervisor(codec.protocol, "Panel")
    found = []
    for n, data in enumerate(payloads):
        fd = len(data) > 8
        frame = can.Message(arbitration_id=256, is_extended_id=False, data=data, is_fd=fd)
        received = receiver.take(frame)
        assert isinstance(received, Received)
        supervisor.take(received, float(n))
        (message,) = supervisor.snapshot(float(n)).messages
        found.append([signal.kind for signal in message.signals] == ["out of range"])
        assert found[-1] or not message.signals
    return found


@pytest.mark.parametrize("form", ["<b", "<h"])
def test_of_a_signed_signal_negative_values_are_judged_as_such(form: str, tmp_path: Path) -> None:
    values = (-41, -40, -1, 0, 100, 101, -128, 127)
    payloads = [struct.pack(form, value) for value in values]
    right = [not -40 <= value <= 100 for value in values]
    for unit in ("", "degC"):  # a count, and a measured value
        assert told(tmp_path, payloads, sign="-", low=-40, high=100, unit=unit) == right


@pytest.mark.parametrize("form", ["<b", "<h"])
def test_a_signed_signal_that_is_never_negative_tells_when_it_is(form: str, tmp_path: Path) -> None:
    highest = 2 ** (8 * struct.calcsize(form)) - 1
    payloads = [struct.pack(form, value) for value in (5, -1, 127, -128)]
    # What no bits can hold, as many databases have it: the highest unsigned number.
    for high in (127, highest):
        found = told(tmp_path, payloads, sign="-", low=0, high=high, unit="bar")
        assert found == [False, True, False, True]


@pytest.mark.parametrize(("form", "kind"), [("<f", 1), ("<d", 2)])
def test_of_a_float_the_value_is_judged_and_not_its_bits(
    form: str, kind: int, tmp_path: Path
) -> None:
    values = (50.0, 9.0, 10.0, 100.0, 101.0, -50.0, 1e30, math.inf, math.nan)
    payloads = [struct.pack(form, value) for value in values]
    payloads.append((50).to_bytes(struct.calcsize(form), "little"))  # next to 0, of bits like 50
    valtype = f"SIG_VALTYPE_ 256 Value : {kind};"
    for low, high in ((10, 100), (0, 1e25)):
        right = [not low - 0.5 <= value <= high for value in (*values, 0.0)]
        assert told(tmp_path, payloads, sign="-", low=low, high=high, kind=valtype) == right


@pytest.mark.parametrize("length", [9, 64, 223])  # the last is of J1939, in several packets
def test_a_number_longer_than_any_float_is_judged_exactly(length: int, tmp_path: Path) -> None:
    most = 2 ** (8 * length) - 1
    payloads = [number.to_bytes(length, "little") for number in (0, 1000, 1001, most)]
    assert told(tmp_path, payloads, sign="+", low=0, high=1000) == [False, False, True, True]
    # A limit with more digits than the model keeps is no trouble either.
    assert told(tmp_path, payloads, sign="+", low=0, high=most // 2) == [False, False, False, True]
