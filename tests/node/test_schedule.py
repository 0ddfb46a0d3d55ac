"""`Schedule`: times worked out by hand, on a clock that is only a number."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import B2V_ST2, B2V_ElecEnergy, B2V_Ucell
from typedcan.node.schedule import Schedule
from typedcan.wire.message import Message


def sent(
    schedule: Schedule, until: float, counts: dict[type[Message], int] | None = None
) -> list[tuple[float, type[Message], int]]:
    """When which frame goes out, if each goes out the moment it is due."""
    frames = []
    while (now := schedule.next_due) <= until:
        due = schedule.due(now)
        assert due is not None
        kind, index = due
        frames.append((now, kind, index))
        schedule.went(kind, (counts or {}).get(kind, 1), now)
    return frames


def begun(kind: type[Message], period: float, due: float = 10.0) -> Schedule:
    schedule = Schedule()
    schedule.resume(kind, period, due)
    return schedule


def test_a_message_is_due_once_a_period() -> None:
    times = [time for time, *_ in sent(begun(B2V_ST2, 0.1), 10.45)]
    assert times == pytest.approx([10.0, 10.1, 10.2, 10.3, 10.4])


def test_nothing_is_due_before_its_time_or_on_an_empty_schedule() -> None:
    assert Schedule().next_due == math.inf
    assert Schedule().due(1e9) is None
    assert begun(B2V_ST2, 0.1).due(9.99) is None


def test_first_transmissions_keep_apart_and_come_soon() -> None:
    schedule = Schedule()
    kinds = PROTOCOL.messages
    for kind in kinds:
        schedule.add(kind, kind.PERIOD or 0.1, 5.0)
    firsts: dict[type[Message], float] = {}
    while len(firsts) < len(kinds):
        now = schedule.next_due
        due = schedule.due(now)
        assert due is not None
        firsts.setdefault(due[0], now)
        schedule.went(due[0], 1, now)
    by_time = sorted(firsts.values())
    assert by_time[0] >= 5.0
    assert by_time[-1] < 5.1
    # 25 messages within 0.1 s: evenly they would be 4 ms apart.
    assert min(b - a for a, b in pairwise(by_time)) > 0.001


def test_a_short_period_begins_within_itself() -> None:
    schedule = Schedule()
    for kind in PROTOCOL.messages:
        schedule.add(kind, 0.01, 5.0)
    assert len({kind for _, kind, _ in sent(schedule, 5.01)}) == len(PROTOCOL.messages)


def test_a_late_transmission_does_not_move_those_after_it() -> None:
    schedule = begun(B2V_ST2, 0.1)
    schedule.went(B2V_ST2, 1, 10.04)
    assert schedule.next_due == pytest.approx(10.1)


def test_cycles_that_a_stall_left_out_are_skipped() -> None:
    schedule = begun(B2V_ST2, 0.1)
    schedule.went(B2V_ST2, 1, 10.35)
    assert [time for time, *_ in sent(schedule, 10.65)] == pytest.approx([10.4, 10.5, 10.6])


def test_nothing_drifts_over_an_hour() -> None:
    schedule = begun(B2V_ElecEnergy, 0.05, due=0.0)
    now = 0.0
    while now < 3600.0:
        now = schedule.next_due
        schedule.went(B2V_ElecEnergy, 1, now + 0.003)
    assert now == pytest.approx(3600.0, abs=1e-6)


def test_the_frames_of_a_cycle_are_spread_evenly_over_it() -> None:
    frames = sent(begun(B2V_Ucell, 0.1), 10.19, {B2V_Ucell: 4})
    assert [index for *_, index in frames] == [0, 1, 2, 3, 0, 1, 2, 3]
    times = [time for time, *_ in frames]
    expected = [10.0, 10.025, 10.05, 10.075, 10.1, 10.125, 10.15, 10.175]
    assert times == pytest.approx(expected)


def test_after_a_stall_the_frames_of_a_cycle_do_not_go_out_all_at_once() -> None:
    schedule = begun(B2V_Ucell, 0.1)
    schedule.went(B2V_Ucell, 10, 10.0)
    schedule.went(B2V_Ucell, 10, 10.35)  # the second of ten frames, 0.34 s late
    frames = sent(schedule, 11.0, {B2V_Ucell: 10})
    assert [index for *_, index in frames[:10]] == [2, 3, 4, 5, 6, 7, 8, 9, 0, 1]
    times = [time for time, *_ in frames]
    assert min(b - a for a, b in pairwise(times)) >= 0.005 - 1e-9
    # In step again: cycles begin at 10.0 plus a multiple of 0.1.
    starts = [time for time, _, index in frames if index == 0]
    assert starts[1:] == pytest.approx([10.5, 10.6, 10.7, 10.8, 10.9, 11.0])


def test_another_number_of_frames_holds_from_the_next_cycle_on() -> None:
    schedule = begun(B2V_Ucell, 0.1)
    first = sent(schedule, 10.09, {B2V_Ucell: 2})
    second = sent(schedule, 10.19, {B2V_Ucell: 5})
    assert [round(time, 3) for time, *_ in first] == [10.0, 10.05]
    assert [round(time, 3) for time, *_ in second] == [10.1, 10.12, 10.14, 10.16, 10.18]


def test_a_message_that_is_added_again_keeps_its_rhythm() -> None:
    schedule = begun(B2V_ST2, 0.1)
    schedule.add(B2V_ST2, 0.1, 9.93)
    assert schedule.next_due == 10.0


def test_another_period_holds_from_the_next_transmission_on() -> None:
    schedule = begun(B2V_ST2, 0.1)
    schedule.add(B2V_ST2, 0.5, 9.93)
    assert [time for time, *_ in sent(schedule, 11.1)] == pytest.approx([10.0, 10.5, 11.0])


def test_a_postponed_transmission_is_late_and_those_after_it_are_not() -> None:
    schedule = begun(B2V_ST2, 0.1)
    schedule.postpone(B2V_ST2, 0.07)
    assert [time for time, *_ in sent(schedule, 10.25)] == pytest.approx([10.07, 10.1, 10.2])


def test_a_transmission_postponed_by_more_than_a_period_leaves_cycles_out() -> None:
    schedule = begun(B2V_ST2, 0.1)
    schedule.postpone(B2V_ST2, 0.25)
    assert [time for time, *_ in sent(schedule, 10.45)] == pytest.approx([10.25, 10.3, 10.4])


def test_a_message_that_is_removed_is_due_no_more() -> None:
    schedule = begun(B2V_ST2, 0.1)
    schedule.remove(B2V_ST2)
    assert schedule.next_due == math.inf
    assert B2V_ST2 not in schedule


@pytest.mark.parametrize("period", [0.0, -1.0, math.inf, math.nan])
def test_a_period_that_is_none_is_refused(period: float) -> None:
    with pytest.raises(ValueError, match="positive number of seconds"):
        Schedule().add(B2V_ST2, period, 0.0)
