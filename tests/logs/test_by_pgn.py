"""Logs of messages that are found by their PGN: the same as live, with addresses in columns."""

from __future__ import annotations

import dataclasses
import json
import random
from pathlib import Path

import can
import numpy as np
import pyarrow as pa
import pyarrow.csv as pacsv
import pytest

import typedcan.__main__ as program
from swapcan.logs import Options, tables
from typedcan.databases.dbc import read_dbc
from typedcan.dynamic import typed_protocol
from typedcan.logs.batch import decode_batch
from typedcan.logs.checks import Checks
from typedcan.logs.decode import Decoder
from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.logs.pipeline import Layout
from typedcan.logs.protocol import known, read
from typedcan.model.protection import Counter
from typedcan.wire.codec import Codec
from typedcan.wire.receiver import Received, Receiver

FIXTURES = Path(__file__).parents[1] / "fixtures"
TRUCK = FIXTURES / "cases" / "j1939-truck.dbc"
LOG = FIXTURES / "logs" / "j1939-truck.log"
GROUPS = FIXTURES / "databases" / "groups.dbc"
MODEL = read_dbc(GROUPS)
PRIORITIES, SOURCES = (3, 6), (0x00, 0x03, 0x13, 0xFE)
IDENTIFIERS = [
    number | priority << 26 | source
    for number in (0x00F00400, 0x0000FE00, 0x00002100, 0x00FECA00, 0x00FEC200, 0x01F00400, 0x400)
    for priority in PRIORITIES
    for source in SOURCES
]


def block(frames: list[tuple[int, bool, bytes]]) -> FrameBlock:
    """Frames as a log gives them, a second apart."""
    count = len(frames)
    return FrameBlock(
        timestamp=np.arange(count, dtype=np.float64),
        frame_id=np.array([number for number, _, _ in frames], np.uint32),
        flags=np.array([FrameFlag.EXTENDED * wide for _, wide, _ in frames], np.uint8),
        channel=np.zeros(count, np.int16),
        length=np.full(count, 8, np.uint8),
        data=np.frombuffer(b"".join(data for _, _, data in frames), np.uint8).reshape(-1, 8),
        channels=("can0",),
    )


def test_the_speeds_of_the_truck_stand_beside_their_sources(tmp_path: Path) -> None:
    output = tmp_path / "truck.csv"
    arguments = ["--dbc", str(TRUCK), "convert", str(LOG), "-o", str(output)]
    assert program.main(arguments) == 0
    assert pacsv.read_csv(output).to_pydict() == {
        "timestamp": [1.0, 1.1, 1.2],
        "channel": ["can0"] * 3,
        "source_address": [0, 3, 254],
        "destination": [255, 255, 255],
        "priority": [6, 6, 6],
        "WheelBasedVehicleSpeed": [16.0, 32.0, 48.0],
    }


def test_a_raster_says_that_it_takes_sources_together(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "truck.csv"
    arguments = ["--dbc", str(TRUCK), "convert", str(LOG), "-o", str(output)]
    said = "CCVS1 is sampled from several sources: 0x00, 0x03, 0xFE"
    assert program.main([*arguments, "--raster", "100ms"]) == 0
    assert said in capsys.readouterr().err
    assert program.main([*arguments, "--raster", "100ms", "--force", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["several_sources"] == {
        "CCVS1": ["0x00", "0x03", "0xFE"]
    }
    assert program.main([*arguments, "--force", "--json"]) == 0  # with a column for the source
    assert json.loads(capsys.readouterr().out)["several_sources"] == {}


def test_a_raster_of_one_source_says_nothing_of_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = tmp_path / "one.log"
    log.write_text("".join(LOG.read_text("ascii").splitlines(keepends=True)[1:2]), "ascii")
    arguments = ["--dbc", str(TRUCK), "convert", str(log), "-o", str(tmp_path / "one.csv")]
    assert program.main([*arguments, "--raster", "100ms"]) == 0
    assert "sources" not in capsys.readouterr().err


def test_each_frame_is_the_message_that_it_is_live() -> None:
    chance = random.Random(1)
    sent = [(chance.choice(IDENTIFIERS), chance.random() < 0.9) for _ in range(3000)]
    frames = [
        (number if wide else number & 0x7FF, wide, chance.randbytes(8)) for number, wide in sent
    ]
    decoder = Decoder(MODEL.messages)
    decoded = decoder.decode(block(frames))
    receiver = Receiver(Codec(typed_protocol(MODEL)))
    live: dict[int, tuple[str, object, object, object]] = {}
    for row, (number, wide, data) in enumerate(frames):
        frame = can.Message(arbitration_id=number, is_extended_id=wide, data=data)
        taken = receiver.take(frame)
        if isinstance(taken, Received):
            facts = (taken.source_address, taken.destination, taken.priority)
            live[row] = (taken.kind.NAME, *facts)
    found: dict[int, tuple[str, object, object, object]] = {}
    for name, columns in decoded.messages.items():
        none = np.full(len(columns), None)
        addresses = columns.addresses if columns.by_pgn else (none, none, none)
        lists = [each.tolist() for each in addresses]
        found.update(
            {row: (name, *at) for row, *at in zip(columns.rows.tolist(), *lists, strict=True)}
        )
    assert found == live
    assert len({name for name, *_ in live.values()}) > 4
    assert decoded.counts.unknown.total() == receiver.counts.foreign > 100


def test_messages_that_are_not_asked_for_take_their_frames_all_the_same() -> None:
    frames = [(0x0CF00403, True, bytes(8)), (0x0CF00400, True, bytes(8))]
    decoded = Decoder(MODEL.messages, wanted={"EngineOfOne": None}).decode(block(frames))
    assert {name: len(columns) for name, columns in decoded.messages.items()} == {"EngineOfOne": 1}
    assert (decoded.counts.unwanted, decoded.counts.unknown.total()) == (1, 0)


def test_counters_and_gaps_are_followed_for_each_source() -> None:
    group = next(each for each in MODEL.messages if each.name == "Fault")
    counting = dataclasses.replace(
        group, counter=Counter(signal="FaultCode", modulus=16), period=1000
    )
    protocol = known(dataclasses.replace(MODEL, messages=(counting,)))
    checks = Checks(protocol)
    decoder = Decoder(protocol.messages)
    frames = [
        (0x18FEC203 + second % 2, True, bytes((5 * (second % 2) + second // 2, *[0] * 7)))
        for second in range(10)
    ]
    frames += [(0x18FEC203, True, bytes((second, *[0] * 7))) for second in (5, 6, 7, 8)]
    for start in (0, 5):
        checks.take(decoder.decode(block(frames[start : start + 5])))
    checks.take(decoder.decode(block(frames[10:])))
    assert checks.finish().counter == {}


def test_one_silent_source_is_a_gap_though_others_send_the_same_message() -> None:
    group = next(each for each in MODEL.messages if each.name == "Fault")
    sent = dataclasses.replace(group, period=1000)
    protocol = read(dataclasses.replace(MODEL, messages=(sent,)), "groups")
    checks = Checks(protocol)
    frames = [(0x18FEC203, True, bytes(8)), *[(0x18FEC204, True, bytes(8))] * 11]
    checks.take(Decoder(protocol.messages).decode(block(frames)))
    gaps = checks.finish().gaps["Fault"]
    assert (gaps.count, gaps.longest) == (1, 11.0)


def test_one_long_table_has_the_addresses_too() -> None:
    options = Options(dbc=TRUCK, layout=Layout.LONG)
    long = tables(LOG, options=options)["signals"]
    assert long["source_address"].to_pylist() == [0, 3, 254]
    assert long["value"].to_pylist() == [16.0, 32.0, 48.0]
    others = Options(dbc=FIXTURES / "logs" / "pack_utf8.dbc", layout=Layout.LONG)
    names = tables(FIXTURES / "logs" / "pack.log", options=others)["signals"].column_names
    assert names[:3] == ["timestamp", "channel", "message"]


def test_a_batch_of_frames_gives_the_same_columns() -> None:
    batch = pa.RecordBatch.from_pydict(
        {
            "timestamp": [1.0, 2.0],
            "frame_id": [0x18FEF100, 0x0CFEF117],
            "data": [bytes.fromhex("FF0010FFFFFFFFFF"), bytes.fromhex("FF0020FFFFFFFFFF")],
        }
    )
    found = decode_batch(batch, own=read(read_dbc(TRUCK), "truck"))["CCVS1"].to_pydict()
    assert (found["source_address"], found["priority"]) == ([0x00, 0x17], [6, 3])
    assert found["WheelBasedVehicleSpeed"] == [16.0, 32.0]


def test_what_takes_several_frames_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "out"
    assert program.main(["--dbc", str(GROUPS), "convert", str(LOG), "-o", str(output)]) == 0
    assert "in several frames, not decoded: Long" in capsys.readouterr().err


def test_decode_says_from_where_a_message_came(capsys: pytest.CaptureFixture[str]) -> None:
    assert program.main(["--dbc", str(TRUCK), "decode", str(LOG)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[5:8] for line in lines] == [
        ["CCVS1", "from", source] for source in ("0x00", "0x03", "0xFE")
    ]
    assert program.main(["--dbc", str(TRUCK), "decode", str(LOG), "--json"]) == 0
    assert '"source_address": 3, "destination": 255, "priority": 6' in capsys.readouterr().out
