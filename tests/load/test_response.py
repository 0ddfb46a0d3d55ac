"""Worst-case response times: the paper's figures, and a bus that arbitrates frame by frame."""

from __future__ import annotations

import heapq
from fractions import Fraction

from hypothesis import given
from hypothesis import strategies as st

from dbcspec.load.response import Stream, Time, worst_case_responses

MS = Fraction(1, 1000)
BIT = Fraction(1, 125_000)


def paper() -> list[Stream]:
    """Table 2 of the paper: A, B and C of 1 ms each."""
    rows = (
        ("A", Fraction(5, 2), Fraction(5, 2)),
        ("B", Fraction(7, 2), Fraction(13, 4)),
        ("C", Fraction(7, 2), Fraction(13, 4)),
    )
    return [
        Stream(name=name, priority=index, time=MS, period=period * MS, deadline=deadline * MS)
        for index, (name, period, deadline) in enumerate(rows)
    ]


def test_the_example_of_the_2007_paper_is_reproduced() -> None:
    responses = worst_case_responses(paper(), BIT)
    assert [response.worst for response in responses] == [2 * MS, 3 * MS, Fraction(7, 2) * MS]
    assert [response.in_time for response in responses] == [True, True, False]


def test_the_first_instance_alone_would_hide_the_missed_deadline() -> None:
    # The older analysis looks at the first instance only: B's and A's frames, then C's own.
    first = MS + MS + MS
    worst = worst_case_responses(paper(), BIT)[2].worst
    assert worst is not None
    assert worst > first


def test_an_overloaded_bus_has_no_bound_for_what_comes_last() -> None:
    streams = [
        Stream(name="high", priority=1, time=MS, period=2 * MS),
        Stream(name="low", priority=2, time=MS, period=2 * MS),
        Stream(name="lowest", priority=3, time=MS, period=20 * MS),
    ]
    high, low, lowest = worst_case_responses(streams, BIT)
    assert high.worst == 2 * MS
    assert (low.worst, lowest.worst) == (None, None)
    assert not lowest.in_time


class Bus:
    """A bus on which the lowest priority wins whenever it is free: an independent simulation."""

    def __init__(self, streams: list[Stream], offsets: list[Time]) -> None:
        self.releases = [
            (offset, stream.priority, stream)
            for stream, offset in zip(streams, offsets, strict=True)
        ]
        heapq.heapify(self.releases)
        self.pending: list[tuple[int, int, Time, Stream]] = []
        self.order = 0
        self.worst: dict[str, Time] = {}

    def release(self, now: Time) -> None:
        """Queue every frame that is released by now."""
        while self.releases and self.releases[0][0] <= now:
            at, priority, stream = heapq.heappop(self.releases)
            for _ in range(stream.frames):
                self.order += 1
                heapq.heappush(self.pending, (priority, self.order, at, stream))
            heapq.heappush(self.releases, (at + stream.period, priority, stream))

    def run(self, until: Time) -> None:
        """Arbitrate until a time."""
        now = Time(0)
        while now < until:
            self.release(now)
            if not self.pending:
                now = self.releases[0][0]
                continue
            _, _, released, stream = heapq.heappop(self.pending)
            now += stream.time
            response = now - released
            self.worst[stream.name] = max(self.worst.get(stream.name, Time(0)), response)


@st.composite
def buses(draw: st.DrawFn) -> tuple[list[Stream], list[Time]]:
    count = draw(st.integers(2, 5))
    streams = [
        Stream(
            name=str(priority),
            priority=priority,
            time=draw(st.integers(1, 4)) * MS / 4,
            period=draw(st.integers(4, 24)) * MS,
            frames=draw(st.integers(1, 3)),
        )
        for priority in range(count)
    ]
    offsets = [draw(st.integers(0, 40)) * MS / 8 for _ in streams]
    return streams, offsets


@given(buses())
def test_no_frame_of_a_simulated_bus_waits_longer_than_its_bound(
    made: tuple[list[Stream], list[Time]],
) -> None:
    streams, offsets = made
    bus = Bus(streams, offsets)
    bus.run(200 * MS)
    for response in worst_case_responses(streams, BIT):
        if response.worst is not None:
            assert bus.worst.get(response.stream.name, Time(0)) <= response.worst


@given(buses())
def test_a_bound_is_reached_where_everything_is_released_together_behind_the_longest_frame(
    made: tuple[list[Stream], list[Time]],
) -> None:
    # The highest priority waits for the longest other frame that has just begun, no longer.
    streams, _ = made
    highest = worst_case_responses(streams, BIT)[0]
    others = max(stream.time for stream in streams[1:])
    own = streams[0]
    if own.utilisation < 1 and others + own.frames * own.time <= own.period:
        assert highest.worst == others + own.frames * own.time
