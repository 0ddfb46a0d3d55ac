"""Thinning: bounded, and nothing that can be seen is lost."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from typedcan.logs.plot.thin import COLUMNS, Points, SpanList, begins_anew, column_length


def noisy(count: int, seed: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    source = np.random.default_rng(seed)
    return np.cumsum(source.random(count) * 0.02), source.normal(size=count)


@settings(max_examples=20, deadline=None)
@given(st.integers(COLUMNS + 1, 200_000), st.integers(0, 1000), st.integers(1, 50_000))
def test_each_column_keeps_first_last_lowest_and_highest(count: int, seed: int, block: int) -> None:
    time, value = noisy(count, seed)
    points = Points()
    for begin in range(0, count, block):
        points.add(time[begin : begin + block], value[begin : begin + block])
    kept_time, kept_value = points.points()
    given_points = set(zip(time.tolist(), value.tolist(), strict=True))
    kept = set(zip(kept_time.tolist(), kept_value.tolist(), strict=True))
    assert kept <= given_points
    assert len(kept_time) <= 4 * (COLUMNS + 1)
    column = np.floor(time / column_length(float(time[-1] - time[0]), COLUMNS))
    for number in np.unique(column)[:: max(1, COLUMNS // 100)]:
        own = np.flatnonzero(column == number)
        for place in (own[0], own[-1], own[value[own].argmin()], own[value[own].argmax()]):
            assert (time[place], value[place]) in kept


def test_few_points_stay_as_they_are() -> None:
    time, value = noisy(COLUMNS, 1)
    points = Points()
    points.add(time, value)
    assert np.array_equal(points.points(), (time, value))


def test_a_single_spike_among_millions_stays_and_memory_is_bounded() -> None:
    points = Points()
    for block in range(100):
        time = np.linspace(block * 50, block * 50 + 49.999, 50_000)
        value = np.zeros(50_000)
        if block == 42:
            value[17] = 1000.0
        points.add(time, value)
    time, value = points.points()
    assert len(time) < 4 * COLUMNS
    assert time[value == 1000.0] == pytest.approx([42 * 50 + 0.017])


def test_points_out_of_order_are_put_in_order() -> None:
    points = Points()
    points.add(np.array([3.0, 1.0, 2.0]), np.array([30.0, 10.0, 20.0]))
    assert [part.tolist() for part in points.points()] == [[1.0, 2.0, 3.0], [10.0, 20.0, 30.0]]


def test_spans_that_touch_are_one_and_others_are_not() -> None:
    held = SpanList()
    held.add(np.array([0.0, 1.0, 3.0]), np.array([1.0, 2.0, 4.0]))
    assert held.spans().tolist() == [[0.0, 2.0], [3.0, 4.0]]


def test_many_spans_become_few_that_cover_them_all() -> None:
    held = SpanList()
    begins = np.arange(100_000) * 1.0
    for part in np.split(begins, 100):
        held.add(part, part + 0.25)
    found = held.spans()
    assert len(found) <= COLUMNS + 1
    at = np.searchsorted(found[:, 0], begins, side="right") - 1
    assert (found[at, 1] >= begins + 0.25).all()


@pytest.mark.parametrize(
    ("span", "anew"),
    [
        ((1.0, 2.0), [True, False, True]),
        ((1.5, 1.6), [True, False, True]),
        ((2.0, 3.0), [True, False, False]),
        ((0.5, 1.5), [True, True, True]),
    ],
)
def test_a_line_begins_anew_behind_a_mark(span: tuple[float, float], anew: list[bool]) -> None:
    points = np.array([0.0, 1.0, 2.0])
    assert begins_anew(points, [np.array([span])]).tolist() == anew
