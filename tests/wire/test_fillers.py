"""Bits that no signal has are sent as the protocol fills them, whichever way they are moved."""

from __future__ import annotations

from typing import Any

import pytest
from generator.small_spec import FILES

from dbcspec.spec.compiled import compile_rows
from dbcspec.spec.folder import read_spec
from typedcan.dynamic import typed_protocol
from typedcan.model.protocol import Protocol, ReservedBits
from typedcan.wire.codec import Codec


def compiled(tmp_path: Any, padding: str) -> Protocol:
    for name, text in FILES.items():
        path = tmp_path / "spec" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")
    behaviour = tmp_path / "spec" / "behaviour.yaml"
    kept = [line for line in behaviour.read_text("utf-8").splitlines() if "padding" not in line]
    behaviour.write_text("\n".join([*kept, f"padding: {padding}", ""]), "utf-8")
    return compile_rows(read_spec(tmp_path / "spec", "spec"), "small").protocol


@pytest.mark.parametrize(
    ("padding", "payload"),
    [
        ("{reserved: 0}", "0000000000000000"),
        ("{reserved: 1}", "00c000ff00000000"),
        ("{reserved: 0, unassigned: 1}", "00000000ffffffff"),
        ("{reserved: 1, unassigned: 1}", "00c000ffffffffff"),
    ],
)
def test_reserved_and_unassigned_bits_are_filled_as_the_spec_says(
    tmp_path: Any, padding: str, payload: str
) -> None:
    # Heater: sum in byte 0, counter and mode to bit 13, temperature in byte 2; reserved are bits
    # 14, 15 and byte 3; nothing is said of bytes 4 to 7.
    protocol = typed_protocol(compiled(tmp_path, padding))
    codec, heater = Codec(protocol), protocol.message("Heater")
    filled = int.from_bytes(bytes.fromhex(payload), "little")
    data = codec.encode(codec.decode(heater, bytes(8), verify=False), renew=True)
    free = 0xFFFF_FFFF_FF00_C000
    assert int.from_bytes(data, "little") & free == filled


def test_what_is_received_there_says_nothing(tmp_path: Any) -> None:
    protocol = typed_protocol(compiled(tmp_path, "{reserved: 0, unassigned: 1}"))
    heater = protocol.message("Heater")
    assert heater.MODEL.reserved[-1] == ReservedBits(start=32, length=32, value=1)
    codec = Codec(protocol)
    plain, ones = (bytes(4) + end for end in (bytes(4), b"\xff" * 4))
    assert codec.decode(heater, plain, verify=False) == codec.decode(heater, ones, verify=False)
