"""The order in which frames take turns, learnt from a log that may lack some of them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

_KEYS = 1 << 16

_ROUNDS = 3
"""How often a key has come when the order is looked for: two cycles are complete then."""


class Rows(NamedTuple):
    """Frames: what tells them apart, seconds since the log's begin, numbers in the log."""

    keys: NDArray[np.uint16]
    times: NDArray[np.float64]
    orders: NDArray[np.int64]

    def last(self, count: int) -> Rows:
        """A copy of the last rows."""
        return Rows(
            self.keys[-count:].copy(), self.times[-count:].copy(), self.orders[-count:].copy()
        )

    def behind(self, before: Rows) -> Rows:
        """All rows of both."""
        return Rows(
            np.concatenate([before.keys, self.keys]),
            np.concatenate([before.times, self.times]),
            np.concatenate([before.orders, self.orders]),
        )

    def time_of(self, key: int, begin: int, end: int) -> float:
        """When a key came last within some rows; -inf where it did not."""
        begin = max(begin, 0)
        same = np.flatnonzero(self.keys[begin:end] == key)
        return float(self.times[begin + same[-1]]) if len(same) else -np.inf


NO_ROWS = Rows(np.empty(0, np.uint16), np.empty(0), np.empty(0, np.int64))


class TurnOrder:
    """The keys of a cycle in their order.

    Parameters
    ----------
    keys
        Each once, below 65536.
    seconds
        How long a cycle takes.
    """

    def __init__(self, keys: Sequence[int], seconds: float) -> None:
        self.keys = tuple(keys)
        self.seconds = seconds
        self.place = {key: place for place, key in enumerate(self.keys)}
        self.next: NDArray[np.uint16] = np.zeros(_KEYS, np.uint16)
        """The key that comes after each."""
        self.next[list(self.keys)] = np.roll(self.keys, -1)

    def __len__(self) -> int:
        """How many keys."""
        return len(self.keys)

    @property
    def unsorted(self) -> int | None:
        """The first key that is lower than the one before it, in a cycle from the lowest on."""
        lowest = self.keys.index(min(self.keys))
        turned = self.keys[lowest:] + self.keys[:lowest]
        for before, key in pairwise(turned):
            if key < before:
                return key
        return None

    def with_key(self, key: int, after: int) -> TurnOrder:
        """The order with one key more: in its place where all are sorted, else after another."""
        if self.unsorted is None:
            return TurnOrder(sorted([*self.keys, key]), self.seconds)
        place = self.place[after] + 1
        return TurnOrder([*self.keys[:place], key, *self.keys[place:]], self.seconds)


class Learner(ABC):
    """Looks for the order in the first frames."""

    def __init__(self) -> None:
        self.keys: list[int] = []
        self.times: list[float] = []
        self.orders: list[int] = []

    def see(self, key: int, time: float, order: int) -> TurnOrder | None:
        """Take a frame; the order, once it is known."""
        self.keys.append(key)
        self.times.append(time)
        self.orders.append(order)
        return self._found()

    @property
    def rows(self) -> Rows:
        """The frames in which the order was found."""
        return Rows(np.array(self.keys, np.uint16), np.array(self.times), np.array(self.orders))

    def _forget(self, count: int) -> None:
        """Go on without the first frames."""
        del self.keys[:count], self.times[:count], self.orders[:count]

    @abstractmethod
    def _found(self) -> TurnOrder | None:
        """The order, where the frames show it."""


class CycleLearner(Learner):
    """Finds the order of cycles of which nothing is known, and what belongs to them."""

    def _found(self) -> TurnOrder | None:
        key, counts = self.keys[-1], Counter(self.keys)
        if counts[key] < _ROUNDS:
            return None
        first = self.keys.index(key)
        keys = self._sorted(counts) or self._repeated()
        if keys is None:
            self._forget(first + 1)
            return None
        return TurnOrder(keys, (self.times[-1] - self.times[first]) / (_ROUNDS - 1))

    def _sorted(self, counts: Counter[int]) -> list[int] | None:
        """All that came more than once, where the numbers fall back once per cycle only."""
        falls = sum(key <= before for before, key in pairwise(self.keys))
        if falls > _ROUNDS - 1:
            return None
        return sorted(key for key, count in counts.items() if count > 1)

    def _repeated(self) -> list[int] | None:
        """The last cycle, where the one before it was the same."""
        newest = self.keys[-1]
        length = self.keys[-2::-1].index(newest) + 1
        last, before = self.keys[-length:], self.keys[-2 * length : -length]
        return last if last == before and len(set(last)) == length else None
