"""AUTOSAR's end-to-end protection of an ARXML file is filled in and checked as cantools does."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import can
import cantools.database
import pytest
from cantools.autosar import end_to_end
from read.autosar import Guarded, arxml

from typedcan.databases.dbc import read_any
from typedcan.dynamic import typed_protocol
from typedcan.logs.batch import decode_batch, frame_batches
from typedcan.logs.protocol import read
from typedcan.model.protection import Counter
from typedcan.model.protocol import Message, Protocol
from typedcan.wire.codec import Codec
from typedcan.wire.errors import ChecksumError

IDS = [dice.randrange(256) for dice in [random.Random(9)] for _ in range(16)]
BRAKE = Guarded(
    "Brake",
    0x120,
    8,
    [("Brake_CRC", 0, 8), ("Brake_Count", 8, 4), ("Force", 16, 16)],
    "PROFILE_02",
    IDS,
)
STEER = Guarded(
    "Steer",
    0x121,
    6,
    [("Steer_CRC", 0, 16), ("Steer_Count", 16, 8), ("Angle", 24, 16)],
    "Profile5",
    [0x1234],
)


def read_protocol(folder: Path, *messages: Guarded) -> Protocol:
    path = folder / "guarded.arxml"
    path.write_text(arxml(*messages), "utf-8")
    return read_any(path)


def read_message(folder: Path, message: Guarded) -> Message:
    return read_protocol(folder, message).message(message.name)


def test_what_is_sent_has_the_crc_that_cantools_makes(tmp_path: Path) -> None:
    protocol = typed_protocol(read_protocol(tmp_path, BRAKE, STEER))
    theirs: Any = cantools.database.load_string(arxml(BRAKE, STEER), "arxml")
    codec = Codec(protocol)
    brake: Any = protocol.message("Brake")
    steer: Any = protocol.message("Steer")
    for count in range(40):
        data = codec.encode(brake(force=count * 1000), counter=count % 16)
        assert end_to_end.check_profile2_crc(data, theirs.get_message_by_name("Brake"))
        assert codec.decode(0x120, data, extended=False) == brake(
            crc=data[0], count=count % 16, force=count * 1000
        )
        data = codec.encode(steer(angle=count), counter=count)
        assert end_to_end.check_profile5_crc(data, theirs.get_message_by_name("Steer"))
        with pytest.raises(ChecksumError):
            codec.decode(0x121, data[:5] + bytes([data[5] ^ 1]), extended=False)


def test_the_counter_is_the_signal_where_the_profile_has_it(tmp_path: Path) -> None:
    protocol = read_protocol(tmp_path, BRAKE, STEER)
    assert protocol.message("Brake").counter == Counter(signal="Brake_Count", modulus=16)
    assert protocol.message("Steer").counter == Counter(signal="Steer_Count", modulus=256)


def test_a_log_is_checked_by_it_too(tmp_path: Path) -> None:
    model = read_protocol(tmp_path, BRAKE, STEER)
    protocol = typed_protocol(model)
    kind: Any = protocol.message("Brake")
    codec = Codec(protocol)
    log = tmp_path / "drive.log"
    with can.Logger(str(log)) as writer:
        for count in range(6):
            data = bytearray(codec.encode(kind(force=count), counter=count))
            data[2] ^= count == 4
            writer.on_message_received(
                can.Message(
                    timestamp=count / 10, arbitration_id=0x120, is_extended_id=False, data=data
                )
            )
    (batch,) = frame_batches(log)
    decoded = decode_batch(batch, own=read(model, "guarded"))
    assert decoded["Brake"].column("Force").to_pylist() == [0, 1, 2, 3, 5]


@pytest.mark.parametrize(
    "message",
    [
        BRAKE._replace(category="PROFILE_01"),
        BRAKE._replace(category="PROFILE_11"),
        BRAKE._replace(category="PROFILE_20"),
        BRAKE._replace(category=""),
        BRAKE._replace(category="PROFILE_05"),
        BRAKE._replace(data_ids=[1, 2]),
        BRAKE._replace(data_ids=[*range(15), 256]),
        BRAKE._replace(signals=[("Brake_CRC", 0, 7), ("Brake_Count", 8, 4)]),
        BRAKE._replace(signals=[("Brake_CRC", 0, 8), ("Brake_Count", 12, 4)]),
        STEER._replace(signals=[("Steer_CRC", 8, 16)]),
        STEER._replace(data_ids=[1 << 16]),
    ],
)
def test_what_is_no_profile_that_is_known_is_left_out(message: Guarded, tmp_path: Path) -> None:
    found = read_message(tmp_path, message)
    assert (found.checksum, found.counter) == (None, None)
    assert len(found.signals) == len(message.signals)


def test_profile_5_needs_no_counter(tmp_path: Path) -> None:
    found = read_message(tmp_path, STEER._replace(signals=[("Steer_CRC", 0, 16)]))
    assert found.counter is None
    assert found.checksum
    assert found.checksum.after == (0x34, 0x12)
