"""In which reading of the spec the frames of one channel come, told by all of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.transfers.readings import ReadingFrames
from typedcan.model.transfer import Numbering, Pace
from typedcan.model.transfers.cycle import NUMBER_BITS, NUMBERS
from typedcan.model.transfers.parts import Parts
from typedcan.model.transfers.recognition import (
    Evidence,
    Said,
    agreeing,
    both,
    candidates_of,
    needed,
    slow_step,
    told_apart,
)

_MEANS: dict[str, dict[int, Enum]] = {
    "numbering": {1: Numbering.THROUGH, -1: Numbering.WITHIN_GROUP},
    "pace": {1: Pace.ONE_A_PERIOD, -1: Pace.ALL_IN_PERIOD},
}


class Recognised:
    """Which reading it is, by the evidence that live nodes go by too, and where it changes.

    Parameters
    ----------
    parts
        The transfer as it is usually read.
    recognise
        Whether to look at all.
    """

    def __init__(self, parts: Parts, *, recognise: bool) -> None:
        self.used: Counter[str] = Counter()
        """By the id of a reading, the cycles that came in it."""
        self.mixtures = 0
        """How often cycles came in another reading than those before."""
        self._candidates = candidates_of(parts) if recognise else ()
        self._differ = told_apart(self._candidates) if self._candidates else frozenset[str]()
        self._evidence = Evidence(self._differ, slow_step(parts))
        self._own = 0
        self._names = ("",) * len(self._candidates[0].about if self._candidates else ())
        self._last: tuple[NDArray[np.int64], NDArray[np.float64]] | None = None
        self._changes: list[tuple[int, int]] = []
        self._facts: dict[str, Enum] = {}

    @property
    def is_open(self) -> bool:
        """Whether frames are to be kept until it is known how they are to be read."""
        return bool(self._evidence.pending)

    @property
    def change(self) -> tuple[int, Parts] | None:
        """The next row of another reading, and how it is read."""
        if not self._changes:
            return None
        row, place = self._changes[0]
        return row, self._candidates[place].parts

    def changed(self) -> None:
        """That reading is the one that is used from now on."""
        self._own = self._changes.pop(0)[1]

    def moved(self, before: int, now: int) -> None:
        """Rows have other numbers than before."""
        self._changes = [(max(row - before, 0) + now, place) for row, place in self._changes]

    def count(self, cycles: int) -> tuple[str, ...]:
        """Count complete cycles; gives the readings in which they came."""
        if not self._differ:
            return ()
        told = self._candidates[self._own].told(self._facts)
        if both(self._names, told):
            self.mixtures += 1
        self._names = tuple(new or old for new, old in zip(told, self._names, strict=True))
        names = tuple(filter(None, told))
        self.used.update(dict.fromkeys(names, cycles))
        return names

    def learn(self, frames: ReadingFrames, begin: int) -> None:
        """Look at further frames, whose rows begin at that number."""
        if not self._differ or not len(frames):
            return
        self._evidence.frames += len(frames)
        key, time = frames.key, frames.time
        if self._last is not None:
            key = np.concatenate([self._last[0], key])
            time = np.concatenate([self._last[1], time])
        first = len(key) - len(frames)
        self._last = key[-1:].copy(), time[-1:].copy()
        groups = key >> NUMBER_BITS
        self._evidence.has_groups |= bool((groups[1:] != groups[:-1]).any())
        said = _said(key, time, self._evidence.slow)
        turns = [
            (row, key_, value)
            for key_ in self._evidence.said
            for row, value in _turns(self._evidence.said[key_], said[key_][first:], _MEANS[key_])
        ]
        facts = self._facts
        for row, key_, value in sorted(turns, key=lambda each: each[0]):
            was_known = key_ in facts
            facts[key_] = value
            self._turn(facts, begin + row if was_known else 0)

    def _turn(self, facts: dict[str, Enum], row: int) -> None:
        place = self._changes[-1][1] if self._changes else self._own
        new = next(agreeing(self._candidates, facts), place)
        if new != place:
            self._changes.append((row, new))


def _said(
    key: NDArray[np.int64], time: NDArray[np.float64], slow: float
) -> dict[str, NDArray[np.int8]]:
    """What each frame says: of numbers, 1 through and -1 within; of steps, 1 slow and -1 quick."""
    group, number = key >> NUMBER_BITS, key & NUMBERS
    numbers = np.zeros(len(key), np.int8)
    goes_on = (group[1:] == group[:-1] + 1) & (number[1:] == number[:-1] + 1)
    numbers[1:][goes_on & (group[:-1] > 0)] = 1
    numbers[(group > 1) & (number == 1)] = -1
    steps = np.zeros(len(key), np.int8)
    late = np.diff(time) >= slow
    steps[1:] = np.where(key[1:] != key[:-1], np.where(late, 1, -1), 0)
    return {"numbering": numbers, "pace": steps}


def _turns(
    said: Said, signs: NDArray[np.int8], means: dict[int, Enum]
) -> Iterator[tuple[int, Enum]]:
    """The rows from which on frames say otherwise, often enough, as `Said.hear` has it."""
    told = np.flatnonzero(signs)
    if not len(told):
        return
    words = signs[told]
    starts = np.concatenate([[0], np.flatnonzero(np.diff(words)) + 1])
    lengths = np.diff(np.append(starts, len(words)))
    values = words[starts]
    if said.times and said.other is means[int(values[0])]:
        lengths[0] += said.times
    at = 0
    while True:
        other = values[at:]
        enough = np.zeros(len(other), np.bool_)
        for sign, value in means.items():
            if value is not said.known:
                enough |= (other == sign) & (lengths[at:] >= needed(value, said.known))
        if not enough.any():
            break
        at += int(enough.argmax())
        said.known = means[int(values[at])]
        yield int(told[starts[at]]), said.known
    last = means[int(values[-1])]
    said.other, said.times = last, 0 if last is said.known else int(lengths[-1])
