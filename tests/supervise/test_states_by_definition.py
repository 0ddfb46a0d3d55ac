"""States and statistics against their definition, over any sequence of frames and checks."""

import statistics
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st
from supervise.arrivals import received, refused

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import B2V_ST2
from typedcan.supervise import NotSeen, State, StateChanged, SupervisionEvent, Supervisor

TICK = 1 / 64
"""A power of two, so that all sums of ticks are exact."""

PERIOD, LATE, TIMEOUT = 8, 12, 40
"""In ticks; late and timeout are 1.5 and 5 periods."""

FRAME = received("B2V_ST2")
REFUSED = refused("B2V_ST2")

calls = st.lists(
    st.tuples(
        st.one_of(st.integers(0, 60), st.sampled_from([PERIOD, LATE, TIMEOUT])),
        st.sampled_from(["frame", "frame", "check", "refused"]),
    ),
    max_size=40,
)


def supervision() -> Supervisor:
    supervisor = Supervisor(PROTOCOL, "VCU", expect=[B2V_ST2])
    supervisor.expect_period(B2V_ST2, PERIOD * TICK)
    supervisor.start(0.0)
    return supervisor


def by_definition(frames: list[int], now: int) -> State:
    """The state at a tick at which somebody looks."""
    if not frames:
        return State.NEVER_SEEN
    silence = now - frames[-1]
    if silence >= TIMEOUT:
        return State.LOST
    return State.LATE if silence >= LATE else State.ALIVE


@given(calls)
def test_states_are_what_the_definition_says(steps: list[tuple[int, str]]) -> None:
    supervisor = supervision()
    frames: list[int] = []
    now = 0
    for ticks, call in steps:
        now += ticks
        if call == "frame":
            supervisor.take(FRAME, now * TICK)
            frames.append(now)
            assert supervisor.state(B2V_ST2) is State.ALIVE
            continue
        if call == "refused":
            supervisor.fault(REFUSED, now * TICK)
        supervisor.check(now * TICK)
        assert supervisor.state(B2V_ST2) is by_definition(frames, now)
        assert supervisor.next_check > now * TICK


@given(calls)
def test_events_tell_the_whole_story(steps: list[tuple[int, str]]) -> None:
    supervisor = supervision()
    events: list[SupervisionEvent] = []
    frames: list[int] = []
    now = 0
    for ticks, call in steps:
        now += ticks
        if call == "frame":
            events += supervisor.take(FRAME, now * TICK)
            frames.append(now)
        else:
            events += supervisor.check(now * TICK)
    changes = [event for event in events if isinstance(event, StateChanged)]
    story = [State.NEVER_SEEN, *(change.new for change in changes)]
    assert [change.old for change in changes] == story[:-1]
    assert story[-1] is supervisor.state(B2V_ST2)
    assert all(old is not new for old, new in pairwise(story))
    assert [event.at for event in events] == sorted(event.at for event in events)
    over = sum(b - a > TIMEOUT for a, b in pairwise(frames))
    on_the_edge = sum(b - a == TIMEOUT for a, b in pairwise(frames))
    silent_now = bool(frames) and now - frames[-1] >= TIMEOUT
    assert over <= story.count(State.LOST) <= over + on_the_edge + silent_now
    missing = (frames[0] if frames else now) >= TIMEOUT
    assert sum(isinstance(event, NotSeen) for event in events) <= missing


@given(st.lists(st.integers(1, 600_000_000), min_size=1, max_size=60))
def test_the_measured_period_is_that_of_the_statistics_module(gaps_in_us: list[int]) -> None:
    supervisor = supervision()
    times = [0.0]
    for gap in gaps_in_us:
        times.append(times[-1] + gap * 1e-6)
    for time in times:
        supervisor.take(received("B2V_ST2", timestamp=1_000.0 + time), time)
    gaps = [b - a for a, b in pairwise(times)]
    (message,) = (m for m in supervisor.snapshot(times[-1]).messages if m.name == "B2V_ST2")
    period = message.period
    assert period.count == len(gaps)
    assert period.mean == pytest.approx(statistics.fmean(gaps), rel=1e-9, abs=1e-9)
    assert period.jitter == pytest.approx(statistics.pstdev(gaps), rel=1e-6, abs=1e-6)
    assert period.worst == pytest.approx(max(gaps), abs=1e-9)
    assert period.shortest == pytest.approx(min(gaps), abs=1e-9)
