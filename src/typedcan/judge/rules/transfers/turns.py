"""Follows frames that take turns in cycles, and says which miss theirs."""

from __future__ import annotations

from bisect import bisect_left
from enum import Enum
from typing import NamedTuple

import numpy as np

from typedcan.judge.rules.transfers.turn_order import NO_ROWS, Rows, TurnOrder
from typedcan.judge.tolerance import TURN_DOUBLED, TURN_LATE, Limits


class Kind(Enum):
    """What can be wrong with a turn."""

    MISSING = "missing"
    DOUBLED = "doubled"
    LATE = "late"
    """After a frame that it usually precedes."""

    UNSORTED = "unsorted"
    """Usually after a frame with a higher number."""


class Fault(NamedTuple):
    """A turn that is not as it should be, and the frame that shows it.

    ``size`` is the number of turns in a cycle.
    """

    kind: Kind
    key: int
    time: float
    order: int
    size: int


class Turns:
    """Counts the turns of frames whose order is known.

    It is always known which turn the farthest frame had, and so which key comes next: frames in
    step cost one comparison for all. A frame out of step

    - is late where its turn was passed over at most half a cycle before, and less than one and a
      half after its key came,
    - else came twice where its key came less than half a cycle before,
    - else passed over the turns before its own.

    A turn that was passed over is missing when its frame can be late no more. What was passed
    over last when frames end is not told.

    Parameters
    ----------
    cycle
        The order.
    key
        Of the farthest frame.
    limits
        How late a frame may be, and how soon it came twice.
    """

    def __init__(self, cycle: TurnOrder, key: int, limits: Limits) -> None:
        self._doubled, self._late_for = limits.limit(TURN_DOUBLED), limits.limit(TURN_LATE)
        self._cycle = cycle
        self._last = key
        self._turn = cycle.place[key]
        self._astray = False  # the last frame was not the farthest
        self._late = 0
        self._passed: dict[int, tuple[float, int]] = {}  # by which frame
        self._strangers: dict[int, float] = {}  # when they came
        self._faults: list[Fault] = []
        self._before = NO_ROWS

    @property
    def is_outdated(self) -> bool:
        """Whether so many frames were late that the order seems to be another."""
        return self._late > 2 * len(self._cycle)

    def follow(self, rows: Rows, begin: int, end: int, before: Rows) -> tuple[int, list[Fault]]:
        """Count rows; where it stopped since the order changed, or the end, and what is wrong.

        ``before`` has the rows before the first of all.
        """
        self._faults, self._before = [], before
        steps = rows.keys[begin:end]
        due = np.empty_like(steps)
        due[0], due[1:] = self._cycle.next[self._last], self._cycle.next[steps[:-1]]
        odd = (np.flatnonzero(steps != due) + begin).tolist()
        odd.append(end)
        row, at, cycle = begin, 0, self._cycle
        while row < end and self._cycle is cycle and not self.is_outdated:
            if not self._astray:  # else the step of the row before says nothing of this one
                at = bisect_left(odd, row, at)
                self._turn += odd[at] - row
                row = odd[at]
            if row < end:
                self._visit(rows, row)
                row += 1
        self._last = int(rows.keys[row - 1])
        self._settle()
        return row, self._faults

    def _visit(self, rows: Rows, row: int) -> None:
        """Count a row that may be out of step."""
        self._settle()
        key, time = int(rows.keys[row]), float(rows.times[row])
        self._astray = True
        if key not in self._cycle.place and not self._is_let_in(key, time):
            return
        cycle = self._cycle
        size, order = len(cycle), int(rows.orders[row])
        ahead = (cycle.place[key] - self._turn) % size
        back = self._turn + ahead - size
        if ahead == 1 % size:
            self._go_to(self._turn + 1, time, order)
        elif self._is_late(rows, row, back):
            del self._passed[back]
            self._late += 1
            self._faults.append(Fault(Kind.LATE, key, time, order, size))
        elif not 0 < ahead <= size // 2 and self._since(rows, row) < self._doubled * cycle.seconds:
            self._faults.append(Fault(Kind.DOUBLED, key, time, order, size))
        else:
            self._go_to(self._turn + (ahead or size), time, order)

    def _is_late(self, rows: Rows, row: int, turn: int) -> bool:
        """Whether a row belongs to a turn that was passed over, not to the next one of its key."""
        near = turn in self._passed and turn >= self._turn - len(self._cycle) // 2
        return near and self._since(rows, row) < self._late_for * self._cycle.seconds

    def _since(self, rows: Rows, row: int) -> float:
        """Seconds since the key of a row came."""
        key, reach = int(rows.keys[row]), 2 * len(self._cycle)
        came = rows.time_of(key, row - reach, row)
        if came == -np.inf and row < reach:
            count = len(self._before.keys)
            came = self._before.time_of(key, count - (reach - row), count)
        return float(rows.times[row]) - came

    def _go_to(self, turn: int, time: float, order: int) -> None:
        """Pass over all turns before one."""
        self._passed.update(dict.fromkeys(range(self._turn + 1, turn), (time, order)))
        self._turn = turn
        self._astray = False

    def _settle(self) -> None:
        """Tell which turns are missing for good."""
        if not self._passed:
            return
        size = len(self._cycle)
        for turn in [turn for turn in self._passed if turn < self._turn - size // 2]:
            key = self._cycle.keys[turn % size]
            self._faults.append(Fault(Kind.MISSING, key, *self._passed.pop(turn), size))

    def _is_let_in(self, key: int, time: float) -> bool:
        """Whether a key that has no turn gets one, since it came in the cycle before too."""
        came = self._strangers.pop(key, -np.inf)
        if time - came > 2 * self._cycle.seconds:
            self._strangers[key] = time
            return False
        farthest = self._cycle.keys[self._turn % len(self._cycle)]
        self._cycle = self._cycle.with_key(key, farthest)
        self._turn = self._cycle.place[farthest]
        self._passed.clear()
        return True
