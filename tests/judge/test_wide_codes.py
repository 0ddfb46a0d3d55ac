"""Codes that only 64 bits hold, ranges beyond what bits hold, and floats, from chunk to chunk."""

from __future__ import annotations

import struct
from pathlib import Path

import can
import numpy as np
import pytest
from rules.recorded import block_of

from typedcan.databases.dbc import read_dbc
from typedcan.dynamic import typed_protocol
from typedcan.judge import Judge
from typedcan.judge.series import Series
from typedcan.logs.decode import Decoder
from typedcan.logs.plan import Mode
from typedcan.wire.protocol import Protocol

_DBC = """VERSION ""

BS_:

BU_: ECU

BO_ 256 Serial: 8 ECU
 SG_ Number : 0|64@1+ (1,0) [0|1000] "" ECU

BO_ 257 Small: 8 ECU
 SG_ Tiny : 0|16@1+ (1E-30,0) [10|20] "" ECU
 SG_ Below : 16|32@1- (1,0) [0|0] "" ECU

BO_ 258 Flow: 8 ECU
 SG_ Mean : 0|64@1- (1,0) [0|0] "" ECU

SIG_VALTYPE_ 258 Mean : 2;
"""


@pytest.fixture
def protocol(tmp_path: Path) -> Protocol:
    path = tmp_path / "wide.dbc"
    path.write_text(_DBC)
    return typed_protocol(read_dbc(path))


def frame(at: float, number: int, data: bytes) -> can.Message:
    return can.Message(timestamp=at, arbitration_id=number, is_extended_id=False, data=data)


def said(protocol: Protocol, *chunks: list[can.Message]) -> list[str]:
    judge = Judge(protocol)
    for chunk in chunks:
        judge.feed(block_of(chunk))
    result = next(each for each in judge.finish().results if each.rule.id == "value-range")
    return [each.says() for each in result.occurrences]


def test_a_number_of_64_bits_is_said_as_it_is_wherever_a_log_is_cut(protocol: Protocol) -> None:
    numbers = [7, (1 << 64) - 1, 1 << 63, 1000]
    frames = [frame(n / 10, 256, each.to_bytes(8, "little")) for n, each in enumerate(numbers)]
    whole = said(protocol, frames)
    assert len(whole) == 1
    assert "1.844674407e+19 (code 18446744073709551615) is outside 0 to 1000" in " ".join(
        whole[0].split()
    )
    assert said(protocol, frames[:2], frames[2:]) == whole
    assert said(protocol, *([each] for each in frames)) == whole


def test_a_range_that_no_code_reaches_is_none_as_where_it_is_sent(protocol: Protocol) -> None:
    assert said(protocol, [frame(0.1, 257, b"\x01" + bytes(7))]) == []


@pytest.mark.parametrize("value", [0.75, -1e300, float("inf")])
def test_floats_are_floats_from_chunk_to_chunk(value: float, protocol: Protocol) -> None:
    kind = protocol.message("Flow")
    decoder = Decoder(protocol.model.messages, mode=Mode.RAW)
    columns = decoder.decode(block_of([frame(0.1, 258, struct.pack("<d", value))]))
    first = Series(kind, columns.messages["Flow"], None, 0.0, 0)
    assert first.value("mean").tolist() == [value]
    before = first.last()  # the decoder uses its memory again
    columns = decoder.decode(block_of([frame(0.2, 258, struct.pack("<d", 0.5))]))
    second = Series(kind, columns.messages["Flow"], before, 0.0, 1)
    assert second.value("mean").tolist() == [value, 0.5]
    assert second.raw("mean").dtype == np.float64


def test_a_log_whose_last_float_is_no_number_is_judged(protocol: Protocol) -> None:
    frames = [frame(n / 10, 258, struct.pack("<d", float("nan"))) for n in range(3)]
    assert said(protocol, frames[:1], frames[1:]) == []
