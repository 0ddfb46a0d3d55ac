"""What the package promises of VIN and pack code when frames are lost, repeated or mixed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache

from hypothesis import given, settings
from hypothesis import strategies as st
from transfer.wire import delivered

from swapcan.transfer import PackCodeAssembler, Problem, VinAssembler, split_pack_code, split_vin
from typedcan.wire.message import Message

Assembler = VinAssembler | PackCodeAssembler
Sent = tuple[float, str, int]
"""When, of which value, which of its frames, counted from 0."""

FRAMES = {17: 3, 24: 4}
"""By the length of a value: a VIN has 17 characters, a pack code 24."""


@cache
def frames_of(value: str) -> list[Message]:
    return delivered(split_vin(value) if len(value) == 17 else split_pack_code(value))


def assembler_for(value: str, rounds: int) -> Assembler:
    if len(value) == 17:
        return VinAssembler(timeout=2.0, rounds=rounds)
    return PackCodeAssembler(rounds=rounds)


def reported(assembler: Assembler, stream: Iterable[Sent]) -> list[str]:
    """What was reported as complete."""
    outcomes = [each for at, value, n in stream for each in assembler.take(frames_of(value)[n], at)]
    return [outcome.text for outcome in outcomes if not isinstance(outcome, Problem)]


def differing(one: str, other: str) -> int:
    """The number of frames in which two values differ."""
    return sum(a != b for a, b in zip(frames_of(one), frames_of(other), strict=True))


@st.composite
def values(draw: st.DrawFn, count: int) -> list[str]:
    """VINs, or pack codes, each of whose frames has one of two contents."""
    sizes = draw(st.sampled_from([(7, 7, 3), (6, 7, 7, 4)]))
    contents = st.tuples(*(st.sampled_from(["A" * size, "B" * size]) for size in sizes))
    drawn = draw(st.lists(contents, min_size=count, max_size=count, unique=True))
    return ["".join(parts) for parts in drawn]


def cycles(value: str, *, count: int, start: float, period: float, spacing: float) -> list[Sent]:
    """The frames of a sender, in order, cycle after cycle."""
    return [
        (start + cycle * period + n * spacing, value, n)
        for cycle in range(count)
        for n in range(FRAMES[len(value)])
    ]


@st.composite
def two_senders(draw: st.DrawFn) -> tuple[list[str], list[Sent]]:
    """Two values, and the frames of their senders by time."""
    pair = draw(values(2))
    stream: list[Sent] = []
    for value in pair:
        period = draw(st.floats(0.9, 1.1))
        stream += cycles(
            value,
            count=draw(st.integers(1, 6)),
            start=draw(st.floats(0, 3)),
            period=period,
            spacing=draw(st.floats(0.001, period / 4.1)),
        )
    return pair, sorted(stream)


@given(values(1), st.data(), st.sampled_from([1, 2]))
def test_of_one_value_nothing_else_comes_out(
    single: list[str], data: st.DataObject, rounds: int
) -> None:
    [value] = single
    picks = st.tuples(st.integers(0, FRAMES[len(value)] - 1), st.floats(0, 1.5))
    at = 0.0
    stream: list[Sent] = []
    for number, later in data.draw(st.lists(picks, max_size=40)):
        at += later
        stream.append((at, value, number))
    assembler = assembler_for(value, rounds)
    assert set(reported(assembler, stream)) <= {value}


@given(values(1), st.lists(st.booleans(), min_size=24, max_size=24), st.sampled_from([1, 2]))
def test_a_value_comes_out_once_it_came_so_often(
    single: list[str], lost: list[bool], rounds: int
) -> None:
    [value] = single
    stream = cycles(value, count=6, start=0, period=1, spacing=0.1)
    arrived = [sent for sent, gone in zip(stream, lost, strict=False) if not gone]
    whole = cycles(value, count=rounds, start=6, period=1, spacing=0.1)
    assert reported(assembler_for(value, rounds), arrived + whole)[-1] == value


@settings(max_examples=120)
@given(two_senders(), st.sampled_from([1, 2]))
def test_two_senders_without_loss_are_never_mixed(
    senders: tuple[list[str], list[Sent]], rounds: int
) -> None:
    pair, stream = senders
    assert set(reported(assembler_for(pair[0], rounds), stream)) <= set(pair)


@settings(max_examples=120)
@given(st.sampled_from([(2, 1), (2, 2), (3, 3), (4, 4)]), st.data())
def test_as_many_senders_as_rounds_in_any_turns_are_never_mixed(
    senders_and_rounds: tuple[int, int], data: st.DataObject
) -> None:
    senders, rounds = senders_and_rounds
    sending = data.draw(values(senders))
    turns = data.draw(st.lists(st.integers(0, senders - 1), max_size=80))
    sent = [0] * senders
    stream: list[Sent] = []
    for step, turn in enumerate(turns):
        stream.append((step * 0.02, sending[turn], sent[turn] % FRAMES[len(sending[turn])]))
        sent[turn] += 1
    assert set(reported(assembler_for(sending[0], rounds), stream)) <= set(sending)


@settings(max_examples=150)
@given(two_senders(), st.data(), st.sampled_from([1, 2]))
def test_two_senders_are_not_mixed_by_fewer_losses_than_frames_differ(
    senders: tuple[list[str], list[Sent]], data: st.DataObject, rounds: int
) -> None:
    pair, stream = senders
    few = differing(*pair) - 1
    lost = data.draw(st.sets(st.integers(0, len(stream) - 1), max_size=few))
    arrived = [sent for index, sent in enumerate(stream) if index not in lost]
    assembler = assembler_for(pair[0], rounds)
    if rounds == 1:  # this much is promised after a first result only
        first = cycles(pair[0], count=1, start=-1, period=1, spacing=0.1)
        assert reported(assembler, first) == pair[:1]
    assert set(reported(assembler, arrived)) <= set(pair)


def changing(pair: Sequence[str], change: int, copies: Sequence[int]) -> list[Sent]:
    """A cyclic stream whose value changes at some frame; each frame so many times, or lost."""
    old = cycles(pair[0], count=8, start=0, period=1, spacing=0.2)
    new = cycles(pair[1], count=8, start=0, period=1, spacing=0.2)
    stream = old[:change] + new[change:]
    return [sent for sent, times in zip(stream, copies, strict=False) for _ in range(times)]


COPIES = st.lists(st.sampled_from([0, 1, 1, 2]), min_size=32, max_size=32)


@settings(max_examples=150)
@given(values(2), st.integers(0, 32), COPIES)
def test_a_change_at_any_point_yields_the_old_or_the_new_value_of_two_rounds(
    pair: list[str], change: int, copies: list[int]
) -> None:
    seen = reported(assembler_for(pair[0], 2), changing(pair, change, copies))
    assert seen == sorted(seen, key=pair.index), "old values first, then new ones, nothing else"


@settings(max_examples=120)
@given(values(2), st.integers(0, 32), COPIES)
def test_a_change_after_a_first_result_yields_the_old_or_the_new_value_of_one_round(
    pair: list[str], change: int, copies: list[int]
) -> None:
    assembler = assembler_for(pair[0], 1)
    first = cycles(pair[0], count=1, start=-1, period=1, spacing=0.1)
    assert reported(assembler, first) == pair[:1]
    assert set(reported(assembler, changing(pair, change, copies))) <= set(pair)


@given(values(2), st.integers(1, 12))
def test_a_change_is_reported_within_three_cycles(pair: list[str], change: int) -> None:
    assembler = assembler_for(pair[0], 2)
    stream = changing(pair, change, [1] * 32)
    cycle = change // FRAMES[len(pair[0])]
    sent = (cycle + 4) * FRAMES[len(pair[0])]
    assert reported(assembler, stream[:sent])[-1] == pair[1]
