"""Cycles of shapes that were seen, and of those that a spec fixes: what is one frame too many."""

from __future__ import annotations

import pytest

from typedcan.model.transfers.cycle import Cycle, Outcome, key_of
from typedcan.model.transfers.shape import FixedShape, Totals, TotalsShape, numbered_through


def outcomes(cycle: Cycle[int], *frames: tuple[int, int, int]) -> list[Outcome]:
    """What frames bring about: each its group, its number, and its last reading with a value."""
    return [cycle.feed(key_of(g, n), within, 0, 0.0) for g, n, within in frames]


def test_a_shape_that_was_seen_gives_way_to_the_fifth_frame_that_it_has_not() -> None:
    cycle = Cycle[int](2, 1.0, FixedShape({1: 2}, surplus=5, forgettable=True))
    assert outcomes(cycle, *[(9, 1, 1)] * 4) == [Outcome.KEPT] * 4
    assert outcomes(cycle, (1, 1, 2)) == [Outcome.COMPLETE]
    assert outcomes(cycle, (9, 1, 1)) == [Outcome.CONTRADICTED]
    assert outcomes(cycle, *[(1, 2, 1)] * 4) == [Outcome.KEPT] * 4
    assert outcomes(cycle, (1, 2, 2)) == [Outcome.CONTRADICTED]


def test_what_has_no_value_is_no_frame_too_many() -> None:
    cycle = Cycle[int](2, 1.0, FixedShape({1: 2}, surplus=5, forgettable=True))
    assert outcomes(cycle, *[(9, 1, 0), (1, 2, 0)] * 9) == [Outcome.KEPT] * 18
    assert cycle.pieces == {}


def test_a_shape_that_the_spec_fixes_knows_no_other_frames() -> None:
    cycle = Cycle[int](2, 1.0, FixedShape({1: 2, 2: 1}))
    strangers = [(3, 1, 1), (1, 2, 1), (0, 1, 1), (1, 0, 1)]
    assert outcomes(cycle, *strangers) == [Outcome.FOREIGN] * 4
    assert outcomes(cycle, (2, 1, 2)) == [Outcome.CONTRADICTED]
    assert outcomes(cycle, (2, 1, 1), (1, 1, 0)) == [Outcome.KEPT, Outcome.COMPLETE]
    assert cycle.counts == {1: 2, 2: 1}


@pytest.mark.parametrize("counts", [{1: 3, 2: 2, 3: 1}, {3: 1, 1: 3, 2: 2}])
def test_numbers_that_run_on_count_the_frames_of_the_groups_before(counts: dict[int, int]) -> None:
    before = numbered_through(counts, 2)
    assert before == {1: 0, 2: 2, 3: 3}
    cycle = Cycle[int](2, 1.0, FixedShape(counts, before))
    assert cycle.wanted == (key_of(1, 1), key_of(1, 2), key_of(2, 3), key_of(3, 4))
    assert outcomes(cycle, (2, 2, 1), (3, 3, 1), (1, 3, 1)) == [Outcome.FOREIGN] * 3
    own = outcomes(cycle, (3, 4, 1), (2, 3, 2), (1, 2, 1), (1, 1, 2))
    assert own == [Outcome.KEPT] * 3 + [Outcome.COMPLETE]


def test_more_different_frames_than_any_cycle_has_take_no_memory() -> None:
    cycle = Cycle[int](1, 1.0, TotalsShape(Totals(65_536, 65_536)))
    frames = [(group, number, 0) for number in (1, 2) for group in range(1, 40_000)]
    found = outcomes(cycle, *frames)
    assert found.count(Outcome.FOREIGN) == len(frames) - 65_536
    assert len(cycle.pieces) == 65_536


@pytest.mark.parametrize(("group", "number"), [(0, 1), (-1, 1), (1, 0), (1, 65_536)])
def test_what_is_no_group_or_number_has_no_key(group: int, number: int) -> None:
    assert key_of(group, number) == 0
    assert key_of(1, 65_535) == (1 << 16) + 65_535
