"""The same rows, and the same faults, as the live runtime has for the same frames."""

from __future__ import annotations

import random
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from logs.cell_logs import INVALID, Reading, Sent, put_together, totals, ucell

from swapcan.log_protocol import CELLS
from swapcan.messages import B2V_BattInfo2
from typedcan.logs.transfers import CycleCounts, ReadingColumns
from typedcan.model.signal_state import SignalState

transfer: Any = pytest.importorskip(
    "swapcan.transfer", reason="the live runtime's transfers are not part of this checkout"
)

Rows = list[tuple[float, list[tuple[int, int]], list[float | None]]]


def rough_log(source: random.Random) -> list[Sent]:
    """A pack of some shape, with losses, repetitions, invalid cells, silences, other totals."""
    csc = source.randint(1, 4)
    each = source.randint(1, 7) if source.random() < 0.5 else None
    counts = {number: each or source.randint(0, 7) for number in range(1, csc + 1)}
    loss, again = source.choice([0, 0, 0.01, 0.05, 0.2]), source.choice([0, 0, 0.02])
    invalid = source.choice([0, 0, 0.05, 0.3])
    dead = source.choice([None, None, (1, counts[1])])
    sent: list[Sent] = []
    time = 0.0
    for number in range(source.randint(5, 60)):
        if source.random() < 0.02:
            time += source.choice([0.3, 3.5, 10])
        if number == 0 or source.random() < 0.1:
            sent.append(Sent(round(time, 6), totals(csc, sum(counts.values()))))
        if source.random() < 0.02:
            wrong = max(0, sum(counts.values()) + source.randint(-1, 1))
            sent.append(Sent(round(time, 6), totals(source.randint(0, csc + 1), wrong)))
        frames = [(c, f) for c, n in counts.items() for f in range(1, (n + 2) // 3 + 1)]
        if source.random() < 0.03:
            source.shuffle(frames)
        if source.random() < 0.02:
            frames.append((source.randint(0, 6), source.randint(0, 4)))
        begin = time
        for c, f in frames:
            places = [(c, 3 * f - 2 + offset) for offset in range(3)]
            values: list[Reading] = [
                INVALID
                if place[1] > counts.get(c, 2) or place == dead or source.random() < invalid
                else source.randint(2000, 4000) / 1000
                for place in places
            ]
            repeats = 1 + (source.random() < again)
            sent += [Sent(round(time, 6), ucell(c, f, *values))] * (
                0 if source.random() < loss else repeats
            )
            time += source.choice([0.002, 0.005, 0.01])
        time = max(time, begin + (0.1 if source.random() < 0.98 else 0.2))
    return sent


def live(sent: list[Sent]) -> tuple[Rows, list[str]]:
    """Rows and kinds of problems by the live runtime, told the time before each message."""
    assembler = transfer.CellAssembler()
    outcomes: list[Any] = []
    for each in sent:
        if isinstance(each.message, B2V_BattInfo2):
            outcomes += assembler.expire(each.time)
        outcomes += assembler.take(each.message, each.time)
    outcomes += assembler.expire(sent[-1].time)
    rows: Rows = []
    problems: list[str] = []
    for outcome in outcomes:
        if isinstance(outcome, transfer.Problem):
            problems.append(outcome.kind)
        else:
            places = [(csc, number) for csc in outcome for number in outcome[csc]]
            values = [None if isinstance(v, SignalState) else round(v, 3) for v in outcome.flat()]
            rows.append((outcome.at, places, values))
    return rows, problems


def from_log(sent: list[Sent], borders: list[int]) -> tuple[Rows, CycleCounts]:
    columns = ReadingColumns([CELLS], assume_seen=False)
    rows: Rows = [
        (time, list(table.positions), [None if v != v else round(v, 3) for v in values])
        for table in put_together(sent, columns, borders)
        for time, values in zip(table.timestamp.tolist(), table.values.tolist(), strict=True)
    ]
    return rows, columns.counts["cells"]


@settings(max_examples=80, deadline=None)
@given(st.integers(0, 2**32), st.integers(1, 400))
def test_rows_and_faults_are_those_of_the_live_runtime(seed: int, block: int) -> None:
    sent = rough_log(random.Random(seed))
    expected, problems = live(sent)
    found, counts = from_log(sent, list(range(block, len(sent), block)))
    assert found == expected
    assert counts.complete == len(expected)
    assert counts.incomplete == problems.count("timeout")
    assert counts.foreign == problems.count("number")
    assert counts.contradictions == problems.count("totals")
