"""Cycles of cell voltages or probe temperatures, each beside those before and after it.

What a pack tells may have been measured up to two periods before it came; and so may each reading,
as a cycle here may begin in the middle of one of the pack's. While the load changes the two differ.
So what is told is compared with five cycles.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from swapcan.rules.shared import CYCLES_APART
from typedcan.judge.chunk import Chunk
from typedcan.judge.tolerance import Limits
from typedcan.logs.columns import State
from typedcan.logs.transfers.cycles import CycleTable
from typedcan.logs.transfers.readings import Readings

Numbers = NDArray[np.float64]

SIDE = 2
"""Cycles on each side."""


@dataclass(frozen=True, slots=True)
class Cycles:
    """n cycles in a row; all but `SIDE` at both ends are to be judged.

    Parameters
    ----------
    positions
        CSC and number of each of the k readings.
    time
        Seconds since the log's begin, of the last frame of each cycle.
    values
        Shape (n, k), NaN where there is none.
    whole
        Whether each reading of a cycle has a value.
    apart
        Seconds between two cycles that are still neighbours.
    """

    positions: tuple[tuple[int, int], ...]
    time: Numbers
    values: Numbers
    whole: NDArray[np.bool_]
    apart: float

    @property
    def judged_at(self) -> Numbers:
        """When those that are to be judged ended."""
        return self.time[SIDE:-SIDE]

    @property
    def near(self) -> NDArray[np.bool_]:
        """Whether those that are to be judged have all neighbours in time."""
        steps = np.diff(self.time)
        good = (steps >= 0) & (steps <= self.apart)
        return _all(good, 2 * SIDE)

    @property
    def surrounded(self) -> NDArray[np.bool_]:
        """Whether those that are to be judged, and their neighbours, have all values."""
        return _all(self.whole, 2 * SIDE + 1)

    def extremes(self, *, highest: bool) -> Numbers:
        """The highest or the lowest value of all n cycles; NaN where none has a value."""
        found: Numbers
        if self.whole.all():
            found = self.values.max(axis=1) if highest else self.values.min(axis=1)
        else:
            found = (np.fmax if highest else np.fmin).reduce(self.values, axis=1)
        return found


def around(values: Numbers) -> tuple[Numbers, Numbers]:
    """The lowest and the highest around each value that is to be judged, this one included."""
    near = _shifted(values, 2 * SIDE + 1)
    return np.minimum.reduce(near), np.maximum.reduce(near)


def _all(good: NDArray[np.bool_], count: int) -> NDArray[np.bool_]:
    """Whether so many in a row are good, from each on."""
    all_good: NDArray[np.bool_] = np.logical_and.reduce(_shifted(good, count))
    return all_good


def _shifted(values: NDArray[Any], count: int) -> list[NDArray[Any]]:
    """The values, and those that are 1, 2, .. places behind, each as long as all have."""
    length = len(values) - count + 1
    return [values[at : at + length] for at in range(count)]


class CycleStream:
    """Hands out the cycles of one kind of readings; each is to be judged once."""

    def __init__(self, readings: Readings, limits: Limits) -> None:
        self._apart = limits.limit(CYCLES_APART)
        self._readings = readings
        self._kept: Cycles | None = None

    def feed(self, chunk: Chunk) -> Iterator[Cycles]:
        """Those that have all neighbours with this chunk."""
        for table in chunk.cycles:
            if table.readings.message == self._readings.message and len(table):
                cycles = self._joined(table, chunk.begin)
                self._kept = Cycles(
                    cycles.positions,
                    cycles.time[-2 * SIDE :].copy(),
                    cycles.values[-2 * SIDE :].copy(),
                    cycles.whole[-2 * SIDE :].copy(),
                    cycles.apart,
                )
                if len(cycles.time) > 2 * SIDE:
                    yield cycles

    def _joined(self, table: CycleTable, begin: float) -> Cycles:
        """The cycles of a table behind those that were kept, where the pack is the same."""
        time = table.timestamp - begin
        values, whole = table.values, (table.state == State.VALUE).all(axis=1)
        kept = self._kept
        if kept is not None and kept.positions == table.positions:
            time = np.concatenate([kept.time, time])
            values = np.concatenate([kept.values, values])
            whole = np.concatenate([kept.whole, whole])
        apart = self._apart * table.readings.period
        return Cycles(table.positions, time, values, whole, apart)
