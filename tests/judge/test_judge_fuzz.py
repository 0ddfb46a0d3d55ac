"""Whatever a log holds is judged: no frame, order or time leads astray, however the log is cut."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from rules.in_blocks import broken
from rules.recorded import block_of, recorded

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform import Judge, Judgement
from typedcan.judge.report import to_csv, to_html, to_json, to_junit
from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.logs.read.blocks import rows_of

FRAMES = 3000
KNOWN = np.array([message.FRAME_ID for message in PROTOCOL.messages], np.uint32)
PLAN = "hv_on@0.5s, ask@1s, drive@2s+2s, charge@5s+4s"


def judged(block: FrameBlock, *bounds: int) -> Judgement:
    """What all rules say of a block, cut at some rows."""
    judge = Judge()
    edges = [0, *bounds, len(block)]
    for begin, end in pairwise(edges):
        judge.feed(rows_of(block, slice(begin, end)))
    return judge.finish("fuzz.log")


def reported(judgement: Judgement) -> str:
    """Every report of it."""
    both = [judgement]
    reports = [to_json(both, "zh"), to_csv(both, "en"), to_junit(both, "zh")]
    return "".join([*reports, to_html(both, [()], "en", {})])


def nonsense(seed: int) -> FrameBlock:
    """Known and unknown identifiers, random bytes, lengths, kinds, channels and times."""
    chance = np.random.default_rng(seed)
    known = chance.choice(KNOWN, FRAMES)
    noise = chance.integers(0, 1 << 29, FRAMES, dtype=np.uint32)
    near = known ^ (np.uint32(1) << chance.integers(0, 29, FRAMES, dtype=np.uint32))
    kind = chance.integers(0, 10, FRAMES)
    frame_id = np.where(kind < 8, known, np.where(kind == 8, near, noise))
    flags = np.where(
        chance.random(FRAMES) < 0.95,
        np.uint8(FrameFlag.EXTENDED),
        chance.integers(0, 128, FRAMES, dtype=np.uint8),
    )
    length = np.where(chance.random(FRAMES) < 0.97, 8, chance.integers(0, 9, FRAMES))
    data = chance.integers(0, 256, (FRAMES, 8), dtype=np.uint8)
    data[np.arange(8) >= length[:, None]] = 0
    steps = chance.exponential(0.005, FRAMES)
    steps[chance.random(FRAMES) < 0.01] *= -300
    steps[chance.random(FRAMES) < 0.005] *= 2000
    return FrameBlock(
        np.cumsum(steps),
        frame_id.astype(np.uint32),
        flags.astype(np.uint8),
        chance.integers(0, 2, FRAMES).astype(np.int16),
        length.astype(np.uint8),
        data,
        ("a", None),
    )


def spoilt(seed: int) -> FrameBlock:
    """What simulated nodes send, with bytes and times changed here and there; some are lost."""
    chance = np.random.default_rng(seed)
    block = block_of(recorded(PLAN, seconds=10.0))
    data, time = block.data.copy(), block.timestamp.copy()
    for _ in range(200):
        data[chance.integers(len(block)), chance.integers(8)] ^= np.uint8(chance.integers(1, 256))
    time[chance.integers(0, len(block), 50)] += chance.normal(0, 0.2, 50)
    order = np.argsort(time, kind="stable")
    rows = order[chance.random(len(block)) < 0.98]
    whole = FrameBlock(
        time, block.frame_id, block.flags, block.channel, block.length, data, block.channels
    )
    return rows_of(whole, rows)


def essence(judgement: Judgement) -> dict[str, tuple[object, ...]]:
    """What must be the same wherever a log is cut."""
    return {
        result.rule.id: (
            result.examined,
            result.count,
            result.frames,
            [(each.subject, round(each.start, 6), each.frames) for each in result.occurrences],
        )
        for result in judgement.results
    }


@pytest.mark.parametrize("seed", range(4))
def test_nonsense_is_judged_and_reported(seed: int) -> None:
    judgement = judged(nonsense(seed))
    assert sum(judgement.frames.values()) == FRAMES
    assert "fuzz.log" in reported(judgement)


@pytest.mark.parametrize("seed", range(4))
def test_what_is_spoilt_here_and_there_is_found_the_same_wherever_it_is_cut(seed: int) -> None:
    block = spoilt(seed)
    cuts = np.sort(np.random.default_rng(seed).integers(1, len(block), 20)).tolist()
    whole = judged(block)
    assert essence(judged(block, *cuts)) == essence(whole)
    assert whole.result("checksum").count > 0
    assert "fuzz.log" in reported(whole)


@pytest.mark.parametrize("seed", range(12))
def test_a_log_that_conforms_may_begin_and_end_anywhere_and_jitter(seed: int) -> None:
    block = block_of(recorded(PLAN, seconds=10.0))
    chance = np.random.default_rng(seed)
    time = block.timestamp + np.clip(np.abs(chance.normal(0, 0.003, len(block))), 0, 0.02)
    for number in np.unique(block.frame_id):  # frames of one identifier do not overtake each other
        own = block.frame_id == number
        time[own] = np.maximum.accumulate(time[own])
    rows = np.argsort(time, kind="stable")
    begin = chance.uniform(0, 5)
    end = begin + chance.uniform(2, 5)
    rows = rows[(time[rows] >= begin) & (time[rows] <= end)]
    jittering = replace(block, timestamp=time)
    judgement = judged(rows_of(jittering, rows))
    assert broken(judgement) == set()
