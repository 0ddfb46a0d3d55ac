"""Nodes that are silent while others are awake, in a protocol of two nodes."""

from __future__ import annotations

import numpy as np
import pytest

from typedcan.databases.dbc import read_dbc
from typedcan.dynamic import typed_protocol
from typedcan.judge import Judge
from typedcan.judge.rules import rules_for
from typedcan.judge.scope import Scope
from typedcan.logs.frames import FrameBlock
from typedcan.wire.protocol import Protocol

DBC = """VERSION ""
NS_ :
BS_:
BU_: A B
BO_ 256 One: 1 A
 SG_ First : 0|8@1+ (1,0) [0|255] "" B
BO_ 512 Two: 1 B
 SG_ Second : 0|8@1+ (1,0) [0|255] "" A
BA_DEF_ BO_ "GenMsgCycleTime" INT 0 65535;
BA_DEF_DEF_ "GenMsgCycleTime" 0;
BA_ "GenMsgCycleTime" BO_ 256 100;
BA_ "GenMsgCycleTime" BO_ 512 100;
"""

Spans = tuple[tuple[float, float], ...]


@pytest.fixture(scope="module")
def protocol(tmp_path_factory: pytest.TempPathFactory) -> Protocol:
    path = tmp_path_factory.mktemp("two") / "two.dbc"
    path.write_text(DBC, "ascii")
    return typed_protocol(read_dbc(path))


def found(protocol: Protocol, a: Spans, b: Spans, **more: object) -> list[str]:
    """Of nodes that send every 100 ms from the begin to the end of some spans of seconds."""
    times = [(time, 256) for span in a for time in _ticks(*span)]
    times += [(time, 512) for span in b for time in _ticks(*span)]
    times.sort()
    count = len(times)
    judge = Judge(protocol, rules_for(protocol, Scope(**more)))  # type: ignore[arg-type]
    judge.feed(
        FrameBlock(
            np.array([time for time, _ in times]),
            np.array([number for _, number in times], np.uint32),
            np.zeros(count, np.uint8),
            np.zeros(count, np.int16),
            np.ones(count, np.uint8),
            np.zeros((count, 8), np.uint8),
            ("can0",),
        )
    )
    result = judge.finish().result("node-awake")
    return [
        f"{each.subject.node} {each.start:g} to {each.end:g}: {each.says()}"
        for each in result.occurrences
    ]


def _ticks(begin: float, end: float) -> list[float]:
    return [round(begin + tick / 10, 6) for tick in range(round((end - begin) * 10) + 1)]


def test_a_silence_is_told_with_who_was_awake_and_for_how_long(protocol: Protocol) -> None:
    assert found(protocol, ((0, 20),), ((0, 4), (10, 20))) == [
        "B 4 to 10: sends nothing for 6 s, though A did; at most 5 s are allowed"
    ]


def test_a_silence_to_the_end_of_the_log_is_one_too(protocol: Protocol) -> None:
    assert found(protocol, ((0, 20),), ((0, 4),)) == [
        "B 4 to 20: sends nothing for 16 s, though A did; at most 5 s are allowed"
    ]


@pytest.mark.parametrize(
    ("a", "b"),
    [
        (((0, 20),), ((0, 4), (9, 20))),  # just as long as it may be
        (((0, 4), (30, 40)), ((0, 4), (30, 40))),  # both sleep
        (((0, 8.9), (30, 40)), ((0, 4), (30, 40))),  # one falls asleep 4.9 s after the other
        (((25.2, 40),), ((0, 4), (30, 40))),  # one comes 4.8 s before the other is back
        (((0, 6), (27.2, 40)), ((0, 4), (30, 40))),  # 2 s and 2.8 s are no 5 s
        (((0, 20),), ((8, 20),)),  # nobody says that it was there before
    ],
)
def test_a_node_may_be_silent_while_nobody_else_is_awake_for_long(
    protocol: Protocol, a: Spans, b: Spans
) -> None:
    assert found(protocol, a, b) == []


def test_one_that_is_awake_in_parts_counts_with_all_of_them(protocol: Protocol) -> None:
    assert found(protocol, ((0, 7), (27, 40)), ((0, 4), (30, 40))) == [
        "B 4 to 30: sends nothing for 26 s, though A did; at most 5 s are allowed"
    ]


def test_a_node_that_may_sleep_is_not_judged(protocol: Protocol) -> None:
    assert found(protocol, ((0, 20),), ((0, 4),), may_sleep=frozenset({"B"})) == []
    told = found(protocol, ((0, 4),), ((0, 20),), may_sleep=frozenset({"B"}))
    assert [each[:9] for each in told] == ["A 4 to 20"]
