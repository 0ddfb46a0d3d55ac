"""Checksums and counters of any kind are judged, not only those of one byte that count from 0."""

from __future__ import annotations

from collections.abc import Iterator

import can
from model.protected import MOTOROLA, message, signal
from oracles.bitwise_crc import Parameters, crc
from rules.recorded import block_of

from typedcan.dynamic import typed_protocol
from typedcan.judge import Judge, Judgement
from typedcan.model.protection import Checksum, Counter
from typedcan.model.protocol import Node, Protocol

CCITT = Parameters(width=16, poly=0x1021, init=0xFFFF, refin=False, refout=False, xorout=0)
GUARDED = typed_protocol(
    Protocol(
        name="guarded",
        nodes=(Node(name="ECU"),),
        messages=(
            message(
                signal("Crc", 55, 16, MOTOROLA),
                signal("Count", 4, 4),
                checksum=Checksum(signal="Crc", algorithm="of_ours", covered=tuple(range(6))),
                counter=Counter(signal="Count", modulus=5, first=3, step=2),
            ),
        ),
    )
)


def frames(counts: list[int], spoilt: int | None = None) -> Iterator[can.Message]:
    for place, count in enumerate(counts):
        data = bytes([count << 4 | 5, place, 0, 0, 0, 7])
        mark = crc(CCITT, data) ^ (place == spoilt)
        yield can.Message(
            timestamp=place / 10,
            arbitration_id=0x123,
            is_extended_id=False,
            data=data + mark.to_bytes(2),
        )


def judged(given: Iterator[can.Message], algorithm: str = "CRC-16/CCITT-FALSE") -> Judgement:
    judge = Judge(GUARDED, algorithms={"of_ours": algorithm} if algorithm else {})
    judge.feed(block_of(list(given)))
    return judge.finish()


def said(judgement: Judgement, rule: str) -> list[str]:
    found = next(each for each in judgement.results if each.rule.id == rule)
    return [each.says() for each in found.occurrences]


def test_what_is_right_is_left_alone() -> None:
    judgement = judged(frames([3, 5, 7, 9, 11, 3, 5]))
    assert [said(judgement, rule) for rule in PROTECTION] == [[], [], []]


def test_a_crc_of_two_bytes_is_judged_and_shown_whole() -> None:
    (text,) = said(judged(frames([3, 5, 7], spoilt=1)), "checksum")
    right = crc(CCITT, bytes([0x55, 1, 0, 0, 0, 7]))
    assert f"checksum 0x{right ^ 1:02X}, the bytes make 0x{right:02X}" in text


def test_without_the_algorithm_nothing_is_said_of_it() -> None:
    assert said(judged(frames([3, 5, 7], spoilt=1), algorithm=""), "checksum") == []


def test_a_counter_is_judged_by_its_range_and_step() -> None:
    (text,) = said(judged(frames([3, 5, 9, 11, 3])), "counter-sequence")
    assert "skipped: the counter goes from 5 to 9 instead of 7" in text
    (text,) = said(judged(frames([11, 3, 3, 5])), "counter-sequence")
    assert "repeated: the counter stays at 3" in text
    # The frame that is refused for its checksum counts.
    assert said(judged(frames([3, 5, 7], spoilt=1)), "counter-sequence") == []


def test_a_value_that_a_counter_does_not_run_through_is_forbidden() -> None:
    for count in (0, 4, 13):
        judgement = judged(frames([3, count, 3]))
        (text,) = said(judgement, "counter-allowed")
        assert f"the counter is {count}; it runs from 3 to 11" in text
        assert said(judgement, "counter-sequence") == []


PROTECTION = ("checksum", "counter-sequence", "counter-allowed")
