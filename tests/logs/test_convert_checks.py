"""Lengths, checksums and counters, held against the live runtime's `Receiver`; gaps by hand."""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import can
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from logs.decode_databases import Frame, block_of
from logs.table_logs import START, traffic, write_frames

import swapcan
from swapcan.log_protocol import OWN
from swapcan.logs import tables
from swapcan.messages import B2V_ST1, B2V_ST2, BSU_BMS_0, MESSAGES, V2B_CMD, B2V_BattInfo2
from swapcan.wire import Receiver
from typedcan.logs.checks import Checks, Faults
from typedcan.logs.decode import Decoder
from typedcan.logs.frames import FrameFlag
from typedcan.logs.pipeline import Options
from typedcan.logs.read import open_log
from typedcan.wire.link import Fault, Received


def _checked(log: Path, block_size: int, *, keep: bool = False) -> tuple[Faults, Counter[str]]:
    """The faults, and the frames that are left of each message."""
    decoder = Decoder(OWN.messages, reserved=OWN.reserved)
    checks = Checks(OWN, keep_faulty=keep)
    left: Counter[str] = Counter()
    with open_log(log, block_size) as source:
        for block in source:
            decoded = checks.take(decoder.decode(block))
            left.update({name: len(columns) for name, columns in decoded.messages.items()})
            assert decoded.counts.decoded == {n: len(c) for n, c in decoded.messages.items()}
    return checks.finish(), left


def _received(frames: Iterable[can.Message]) -> tuple[dict[str, Counter[str]], Counter[str]]:
    """What the live runtime finds: by kind of fault and message, and by message what is left."""
    receivers: dict[object, Receiver] = {}
    faults: dict[str, Counter[str]] = {
        kind: Counter() for kind in ("length", "checksum", "counter")
    }
    left: Counter[str] = Counter()
    for frame in frames:
        taken = receivers.setdefault(frame.channel, Receiver()).take(frame)
        if isinstance(taken, Fault):
            faults[taken.kind][taken.message] += 1
        elif isinstance(taken, Received):
            left[taken.message.NAME] += 1
            for fault in taken.faults:
                faults[fault.kind][fault.message] += 1
    return faults, left


def _spoilt(frames: list[can.Message], seed: int, *, channels: int = 1) -> list[can.Message]:
    """The frames with faults of every kind: lost, doubled, cut, lengthened, with wrong bytes."""
    noise = random.Random(seed)
    spoilt = []
    for frame in frames:
        frame.channel = noise.randrange(channels)
        kind = noise.choice(["lost", "double", "cut", "bytes", "counter", *["sound"] * 15])
        data = bytearray(frame.data)
        if kind == "cut":
            data = data[: noise.randrange(len(data))]
        elif kind == "bytes":
            data[noise.randrange(len(data))] ^= noise.randrange(1, 256)
        elif kind == "counter":
            data = bytearray(noise.randbytes(len(data)))
            message = swapcan.decode(frame.arbitration_id, bytes(data), verify=False)
            data = bytearray(_sealed(type(message), bytes(data)))
        frame.data, frame.dlc = data, len(data)
        spoilt += [frame] * {"lost": 0, "double": 2}.get(kind, 1)
    return spoilt


def _sealed(kind: type[swapcan.Message], data: bytes) -> bytes:
    """The payload with the checksum that the runtime expects."""
    try:
        swapcan.decode(kind.FRAME_ID, data)
    except swapcan.ChecksumError as error:
        assert kind.CHECKSUM
        assert kind.CHECKSUM.signal.endswith("_Checksum")  # byte 0 of all that have one
        return bytes([error.expected]) + data[1:]
    return data


@pytest.mark.parametrize("channels", [1, 3])
@pytest.mark.parametrize("block_size", [7, 100, 100_000])
def test_faults_are_those_of_the_live_runtime(
    tmp_path: Path, block_size: int, channels: int
) -> None:
    frames = _spoilt(traffic(15), seed=channels, channels=channels)
    log = write_frames(tmp_path / "spoilt.blf", frames)
    expected, left = _received(frames)
    faults, found = _checked(log, block_size)
    assert (faults.length, faults.checksum, faults.counter) == tuple(expected.values())
    assert found == left
    assert all(counts.total() > 10 for counts in expected.values())


def test_kept_faulty_frames_are_counted_all_the_same(tmp_path: Path) -> None:
    frames = _spoilt(traffic(10), seed=3)
    log = write_frames(tmp_path / "spoilt.blf", frames)
    expected, _ = _received(frames)
    faults, found = _checked(log, 100, keep=True)
    assert (faults.length, faults.checksum, faults.counter) == tuple(expected.values())
    lengths = {kind.FRAME_ID: kind for kind in MESSAGES}
    whole = Counter(
        lengths[frame.arbitration_id].NAME
        for frame in frames
        if len(frame.data) >= lengths[frame.arbitration_id].LENGTH
    )
    assert found == whole


@given(st.lists(st.integers(0, 15), min_size=1, max_size=40), st.integers(1, 12))
def test_any_sequence_of_counters_is_judged_as_the_live_runtime_judges_it(
    counters: list[int], block_size: int
) -> None:
    frames = []
    for place, number in enumerate(counters):
        for kind in (V2B_CMD, B2V_ST1, BSU_BMS_0):
            sent = swapcan.encode(kind(), counter=number)
            frames.append(can.Message(START + place, kind.FRAME_ID, data=sent, channel=0))
    expected, _ = _received(frames)
    assert _counter_faults(frames, block_size) == expected["counter"]


def _counter_faults(frames: list[can.Message], block_size: int) -> Counter[str]:
    decoder, checks = Decoder(OWN.messages), Checks(OWN)
    for start in range(0, len(frames), block_size):
        part = frames[start : start + block_size]
        block = block_of([Frame(f.arbitration_id, bytes(f.data), FrameFlag.EXTENDED) for f in part])
        one_channel = replace(block, channel=np.zeros(len(part), np.int16))
        checks.take(decoder.decode(one_channel))
    return checks.finish().counter


def test_a_frame_with_a_wrong_checksum_is_in_no_table_unless_it_is_kept(tmp_path: Path) -> None:
    sound = bytearray(swapcan.encode(B2V_ST1(), counter=3))
    wrong = bytes([sound[0] ^ 1, *sound[1:]])
    frames = [
        can.Message(START + n, B2V_ST1.FRAME_ID, data=data)
        for n, data in enumerate([sound, wrong, sound])
    ]
    log = write_frames(tmp_path / "x.log", frames)
    assert tables(log)["B2V_ST1"].column("timestamp").to_pylist() == [START, START + 2]
    kept = tables(log, options=Options(keep_faulty=True))["B2V_ST1"]
    assert kept.column("timestamp").to_pylist() == [START, START + 1, START + 2]


@pytest.mark.parametrize("block_size", [1, 3, 1000])
def test_gaps_are_pauses_of_more_than_five_periods_and_the_silence_at_the_end(
    tmp_path: Path, block_size: int
) -> None:
    period = B2V_ST2.PERIOD
    assert period == 0.1
    times = [0.0, 0.1, 0.59, 1.2, 1.3, 2.1]  # pauses of 0.49, 0.61 and 0.8 seconds
    frames = [can.Message(START + t, B2V_ST2.FRAME_ID, data=bytes(8)) for t in times]
    frames.append(can.Message(START + 4.1, V2B_CMD.FRAME_ID, data=bytes(8)))
    faults, _ = _checked(write_frames(tmp_path / "x.log", frames), block_size)
    assert {name: gaps.count for name, gaps in faults.gaps.items()} == {"B2V_ST2": 3}
    assert faults.gaps["B2V_ST2"].longest == pytest.approx(2.0)


def test_gaps_of_one_channel_are_not_filled_by_another(tmp_path: Path) -> None:
    frames = [
        can.Message(START + n / 10, B2V_ST2.FRAME_ID, data=bytes(8), channel=0) for n in range(30)
    ]
    frames += [
        can.Message(START + n / 10 + 0.01, B2V_ST2.FRAME_ID, data=bytes(8), channel=1)
        for n in (0, 1, 20, 21, 22, 23, 24, 25, 26, 27, 28)
    ]
    log = write_frames(tmp_path / "x.blf", sorted(frames, key=lambda frame: frame.timestamp))
    faults, _ = _checked(log, 10)
    assert faults.gaps["B2V_ST2"].count == 1
    assert faults.gaps["B2V_ST2"].longest == pytest.approx(1.9)


def test_messages_on_request_have_no_gap_when_the_request_is_withdrawn(tmp_path: Path) -> None:
    # B2V_BattInfo2 has a period of 100 ms, while V2B_RQData asks for it.
    frames = [can.Message(START + n / 10, B2V_BattInfo2.FRAME_ID, data=bytes(8)) for n in range(5)]
    frames.append(can.Message(START + 9.0, V2B_CMD.FRAME_ID, data=bytes(8)))
    faults, _ = _checked(write_frames(tmp_path / "x.log", frames), 10)
    assert not faults.gaps
