"""Random frames of every kind of transfer: a live node and the columns of a log tell the same."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from transfer.rack import rack

from typedcan.logs.columns import MessageColumns
from typedcan.logs.decode import Decoder
from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.logs.protocol import known
from typedcan.logs.transfers import CycleCounts, ReadingColumns
from typedcan.logs.transfers.values import ValueColumns
from typedcan.model.signal_state import SignalState
from typedcan.transfer import Assembler, Blocks, Problem, Readings, Text, split
from typedcan.wire.codec import Codec
from typedcan.wire.message import Message

PROTOCOL = rack()
CODEC = Codec(PROTOCOL)
LOG = known(PROTOCOL.model)
LETTERS = "AB架7"


@dataclass(frozen=True)
class Sent:
    """A frame of a message, and when it came."""

    time: float
    message: type[Message]
    data: bytes


def value_of(name: str, source: random.Random) -> Any:
    """Some value of a transfer."""
    if name == "name":
        return "".join(source.choices(LETTERS, k=source.randint(1, 8)))
    if name == "serial":
        text = "".join(source.choices("AB7", k=source.randint(1, 8)))
        return Text("serial", text, {"maker": source.randint(0, 2)})
    if name == "key":
        data = source.randbytes(source.randint(1, 12))
        return Blocks("key", tuple(data), {"id": source.randint(0, 1)})
    if name == "curve":
        return [source.randint(-100, 500) / 1 for _ in range(5)]
    counts = [4, 3, 2] if name == "heats" else [source.randint(0, 5) for _ in range(3)]
    first = 0 if name == "heats" else 1
    return {
        group: [
            SignalState.INVALID if source.random() < 0.1 else float(source.randint(0, 99))
            for _ in range(count)
        ]
        for group, count in enumerate(counts, first)
    }


def totals(value: dict[int, list[Any]], source: random.Random) -> bytes:
    wrong = source.choice([0, 0, 0, 0, 1, -1])
    count = max(0, sum(map(len, value.values())) + wrong)
    return bytes([len(value) if source.random() < 0.95 else 0, count])


def rough(name: str, source: random.Random) -> list[Sent]:
    """Frames of some values in turns: lost, repeated, out of order, changed, with silences."""
    transfer = PROTOCOL.transfer(name)
    period = transfer.parts.period or 0.3
    values = [value_of(name, source) for _ in range(source.choice([1, 1, 2]))]
    loss, again = source.choice([0, 0, 0.05, 0.2]), source.choice([0, 0, 0.05])
    noise = source.choice([0, 0, 0.03])
    sent: list[Sent] = []
    time = 1.0
    value = values[0]
    for _ in range(source.randint(2, 25)):
        if source.random() < 0.2:
            value = source.choice(values)
        if name == "weights" and (not sent or source.random() < 0.3):
            sent.append(Sent(time, PROTOCOL.message("TOTALS"), totals(value, source)))
        frames = [(type(each), CODEC.encode(each)) for each in split(transfer, value)]
        if source.random() < 0.1:
            source.shuffle(frames)
        step = period / (len(frames) + 1) * source.choice([0, 0.2, 1, 1, 1.1])
        for kind, data in frames:
            sound = source.random() >= noise
            frame = Sent(round(time, 3), kind, data if sound else source.randbytes(len(data)))
            sent += [frame] * (0 if source.random() < loss else 1 + (source.random() < again))
            time += step
        time += source.choice([0, 0.1, 0.1, 0.1, 1, 3, 40]) * period
    return sent


def live(name: str, sent: list[Sent]) -> list[Any]:
    """What an assembler tells, with time passing as it does for a node."""
    assembler = Assembler[Any](PROTOCOL.transfer(name))
    told: list[Any] = []

    def expire(now: float) -> None:
        while (due := assembler.deadline) <= now:
            told.extend(assembler.expire(due))

    for each in sent:
        expire(each.time)
        message = CODEC.decode(each.message.FRAME_ID, each.data, extended=False)
        told += assembler.take(message, each.time)
    if sent:
        expire(sent[-1].time)
    return told


def blocks(sent: list[Sent], size: int) -> Iterator[dict[str, MessageColumns]]:
    """The frames decoded, so many at a time."""
    decoder = Decoder(LOG.messages, reserved=LOG.reserved)
    edges = [*range(0, len(sent), size), len(sent)]
    for begin, end in pairwise(edges):
        part = sent[begin:end]
        data = np.zeros((len(part), 8), np.uint8)
        for row, each in zip(data, part, strict=True):
            row[: len(each.data)] = list(each.data)
        block = FrameBlock(
            timestamp=np.array([each.time for each in part]),
            frame_id=np.array([each.message.FRAME_ID for each in part], np.uint32),
            flags=np.full(len(part), int(FrameFlag(0)), np.uint8),
            channel=np.zeros(len(part), np.int16),
            length=np.array([len(each.data) for each in part], np.uint8),
            data=data,
            channels=("can0",),
        )
        yield decoder.decode(block).messages


def plain(value: Any) -> Any:
    """A value as what can be compared whichever way it was decoded."""
    if isinstance(value, Text):
        return value.text, {key: int(each) for key, each in value.details.items()}, value.at
    if isinstance(value, Blocks):
        return value.values, dict(value.details), value.at
    flat = [None if isinstance(each, SignalState) else each for each in value.flat()]
    return [(g, n) for g in value for n in value[g]], flat, value.at


@pytest.mark.parametrize("name", ["name", "serial", "key", "curve"])
@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2**32), size=st.integers(1, 60))
def test_texts_and_blocks_and_what_is_wrong_with_them(name: str, seed: int, size: int) -> None:
    sent = rough(name, random.Random(seed))
    expected = live(name, sent)
    columns = ValueColumns(each for each in LOG.values if each.transfer.name == name)
    found = [plain(each.value) for block in blocks(sent, size) for each in columns.add(block)]
    columns.finish()
    assert found == [plain(each) for each in expected if not isinstance(each, Problem)]
    assert columns.problems == [each for each in expected if isinstance(each, Problem)]


@pytest.mark.parametrize("name", ["weights", "heats"])
@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 2**32), size=st.integers(1, 60))
def test_readings_and_what_is_wrong_with_them(name: str, seed: int, size: int) -> None:
    sent = rough(name, random.Random(seed))
    expected = live(name, sent)
    kinds = [each.kind for each in expected if isinstance(each, Problem)]
    columns = ReadingColumns(
        [each for each in LOG.readings if each.name == name], assume_seen=False
    )
    tables = [table for block in blocks(sent, size) for table in columns.add(block)]
    tables += columns.finish()
    found = [
        (list(table.positions), [None if math.isnan(v) else v for v in values], at)
        for table in tables
        for at, values in zip(table.timestamp.tolist(), table.values.tolist(), strict=True)
    ]
    assert found == [plain(each) for each in expected if isinstance(each, Readings)]
    counts = columns.counts[name]
    assert counts.complete == len(found)
    assert counts.incomplete == kinds.count("timeout")
    assert counts.foreign == kinds.count("number")
    assert counts.contradictions == kinds.count("totals")
    assert isinstance(counts, CycleCounts)


@pytest.mark.parametrize("name", [each.name for each in PROTOCOL.transfers])
def test_the_random_frames_complete_values_and_break_others(name: str) -> None:
    told = [each for seed in range(60) for each in live(name, rough(name, random.Random(seed)))]
    problems = {each.kind for each in told if isinstance(each, Problem)}
    assert sum(not isinstance(each, Problem) for each in told) > 30
    assert {"timeout", "length" if name == "serial" else "number"} <= problems
