"""The frames of one message on one channel, from block to block."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import groupby
from operator import attrgetter

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.transfers.assembly import Assembly, Complete, CycleCounts
from typedcan.logs.transfers.readings import ReadingFrames, Readings, no_frames
from typedcan.logs.transfers.recognised import Recognised
from typedcan.model.transfer import Numbering, Pace
from typedcan.model.transfers.cycle import NUMBER_BITS, NUMBERS, WINDOW, frames_in
from typedcan.model.transfers.parts import Parts
from typedcan.model.transfers.shape import (
    FixedShape,
    Shape,
    Totals,
    frames_of,
    shape_of,
    totals_of,
)

_WATCHED = 2.0
"""Seconds that are watched for what a cycle has."""

_TWICE = 2
"""How often all frames are watched where one comes in a period."""

_WATCHED_FRAMES = 1 << 16
"""More frames are never watched, whatever their times."""

_SURPLUS = 5
"""How many frames beyond what was seen show that there is more."""

_OFTEN = 0.5
"""Frames that came less often than this, beside the most frequent one, are taken for errors."""

Layout = tuple[tuple[int, int], ...]
"""Groups from 1, each with the number of its readings, ascending."""


@dataclass(frozen=True, slots=True)
class Cycles:
    """Complete cycles of one layout: times, readings and their states, a row per cycle."""

    layout: Layout
    timestamp: NDArray[np.float64]
    values: NDArray[np.float64]
    state: NDArray[np.uint8]
    read_as: tuple[str, ...] = ()


class Stream:
    """Holds what is not complete yet, and finds out what a cycle has.

    Parameters
    ----------
    readings
        What they carry.
    assume_seen
        Whether to watch what comes while there are no totals.
    recognise
        Whether to go by the reading of the spec that frames tell, where it has several.

    Attributes
    ----------
    recognised
        Which reading that is.
    """

    def __init__(self, readings: Readings, *, assume_seen: bool, recognise: bool = True) -> None:
        self.recognised = Recognised(readings.parts, recognise=recognise)
        self._parts = readings.parts
        self._totals: Totals | None = None
        self._width = len(readings.items)
        self._assume_seen = assume_seen
        self._contradictions = 0
        self._assembly: Assembly | None = None
        self._held = no_frames(self._width)
        self._next = 0  # of the rows held: before are those that pieces point to
        self._stop = 0  # of the rows held: from here on they are still to be taken
        self._unassigned = 0
        if not readings.total_signals:
            self.set_totals((), 0.0)

    @property
    def counts(self) -> CycleCounts:
        """What became of the frames."""
        counts = CycleCounts(unassigned=self._unassigned, contradictions=self._contradictions)
        if self._assembly is not None:
            counts.add(self._assembly.counts)
        return counts

    @property
    def _is_known(self) -> bool:
        """Whether it is known what a cycle has."""
        return self._assembly is not None and not self._assembly.forgotten

    def hold(self, frames: ReadingFrames) -> None:
        """Keep the frames of a block, to be taken next."""
        self._drop()
        begin = len(self._held)
        self._held = self._held.followed_by(frames)
        self.recognised.learn(frames, begin)

    def take(self, count: int) -> list[Cycles]:
        """Take so many of the frames that are held, in their order."""
        self._stop += count
        return self._taken(final=False)

    def _taken(self, *, final: bool, wait: bool = True) -> list[Cycles]:
        """What is complete, from one change of the reading to the next.

        With ``wait`` frames are kept until it is known how to read them.
        """
        waits = wait and (self._assume_seen or self._is_known) and self.recognised.is_open
        if waits and not final:
            return []
        found: list[Cycles] = []
        end = self._stop
        while True:
            change = self.recognised.change
            self._stop = end if change is None else min(end, max(change[0], self._next))
            while self._next < self._stop and self._ready(final=final):
                found += self._run()
            if change is None or self._stop == end:
                break
            self._stop = end
            self._read_as(change[1], change[0])
        self._stop = end
        return found

    def _read_as(self, parts: Parts, row: int) -> None:
        """Go on in another reading of the spec, from that row on."""
        self.recognised.changed()
        self._parts = parts
        self._next = max(self._next, row)
        at = float(self._held.time[row]) if row < len(self._held) else 0.0
        shape = shape_of(parts, self._totals) if self._totals else ""
        if not isinstance(shape, str):
            self._begin(shape, at, self._totals)
        elif self._assembly is not None:
            self._assembly.forget(at)

    def set_totals(self, values: tuple[int | None, ...], at: float) -> list[Cycles]:
        """Take other totals, at that time, in the order of groups and readings in all.

        Gives what frames make that were kept until now.
        """
        found = self._taken(final=False, wait=False) if self._is_known else []
        self._totals = totals = totals_of(self._parts, values)
        shape = None if totals is None else shape_of(self._parts, totals)
        if isinstance(shape, str):
            self._contradictions += 1
        elif shape is not None:
            self._begin(shape, at, totals)
            return found
        if self._assembly is not None:
            self._assembly.forget(at)
        return found

    def finish(self, end: float) -> list[Cycles]:
        """What is left; the log ends at that time."""
        found = self._taken(final=True)
        if self._assembly is not None and not self._assembly.forgotten:
            self._assembly.expire(end)
        return found

    def _ready(self, *, final: bool) -> bool:
        """Whether it is known what a cycle has; ``final``: no more frames will come."""
        if self._is_known:
            return True
        if not self._assume_seen:
            self._unassigned += self._stop - self._next
            self._next = self._stop
            return False
        frames = self._held
        part = slice(self._next, self._stop)
        with_values = np.flatnonzero(frames.within[part] > 0)
        begin = self._next + int(with_values[0]) if len(with_values) else self._stop
        self._unassigned += begin - self._next
        self._next = begin
        later = self._watched(begin)
        if not (final or later.any() or self._stop - begin >= _WATCHED_FRAMES):
            return False
        end = begin + int(later.argmax()) if later.any() else self._stop
        self._watch(begin, end)
        return begin < self._stop

    def _watched(self, begin: int) -> NDArray[np.bool_]:
        """Which of the frames come when enough was seen.

        That is after some seconds, or where one frame comes in a period once all have come twice.
        """
        part = slice(begin, self._stop)
        times = self._held.time[part]
        if self._parts.transfer.pace is Pace.ONE_A_PERIOD:
            again = np.flatnonzero(self._held.key[part] == self._held.key[begin])
            if len(again) <= _TWICE:
                return np.zeros(len(times), np.bool_)
            third: NDArray[np.bool_] = np.arange(len(times)) >= again[_TWICE]
            return third
        later: NDArray[np.bool_] = times >= times[:1] + _WATCHED
        return later

    def _watch(self, begin: int, end: int) -> None:
        if begin == end:
            return
        part = slice(begin, end)
        seen = zip(self._held.key[part].tolist(), self._held.within[part].tolist(), strict=True)
        through = self._parts.transfer.numbering is Numbering.THROUGH
        shape = seen_shape(seen, self._width, through=through)
        self._begin(shape, float(self._held.time[begin]))

    def _begin(self, shape: Shape, at: float, totals: Totals | None = None) -> None:
        if totals is None:
            frames = sum(len(frames_in(n, self._width)) for n in (shape.counts() or {}).values())
        else:
            frames = frames_of(self._parts, totals)
        window = self._parts.seconds(WINDOW, frames)
        if self._assembly is None:
            self._assembly = Assembly(self._width, window, shape)
        else:
            self._assembly.begin(shape, at, window)

    def _run(self) -> list[Cycles]:
        if self._assembly is None:
            return []
        self._next, complete = self._assembly.run(self._held, self._next, self._stop)
        return [self._cycles(each) for each in _joined(complete)]

    def _cycles(self, complete: Complete) -> Cycles:
        kept: list[int] = []
        first = 0
        for _, count in complete.counts:
            kept.extend(range(first, first + count))
            first += len(frames_in(count, self._width)) * self._width
        rows = complete.rows
        values = self._held.values[rows].reshape(len(rows), -1)
        state = self._held.state[rows].reshape(len(rows), -1)
        if len(kept) < values.shape[1]:
            values, state = values[:, kept], state[:, kept]
        read_as = self.recognised.count(len(rows))
        return Cycles(complete.counts, self._held.time[rows.max(axis=1)], values, state, read_as)

    def _drop(self) -> None:
        """Keep the rows that are still needed."""
        pieces = {} if self._assembly is None else self._assembly.pieces
        old = sorted(pieces.values())
        waiting = np.arange(self._next, len(self._held))
        rows = np.concatenate([np.array(old, np.int64), waiting])
        self._held = self._held.rows(rows)
        places = {row: place for place, row in enumerate(old)}
        for key, row in pieces.items():
            pieces[key] = places[row]
        self.recognised.moved(self._next, len(old))
        self._next = len(old)
        self._stop = len(self._held)


def seen_shape(
    frames: Iterable[tuple[int, int]], width: int, *, through: bool = False
) -> FixedShape:
    """The shape that frames show: each its key, and the last of its readings with a value.

    ``through``: the frames are numbered through all groups.
    """
    often: Counter[int] = Counter()
    last: dict[int, int] = {}
    for key, within in frames:
        if key > NUMBERS and key & NUMBERS and within:
            often[key] += 1
            last[key] = max(within, last.get(key, 0))
    enough = _OFTEN * max(often.values(), default=0)
    numbers: dict[int, dict[int, int]] = {}
    for key in sorted(key for key, count in often.items() if count >= enough):
        numbers.setdefault(key >> NUMBER_BITS, {})[key & NUMBERS] = last[key]
    before = {group: min(own) - 1 if through else 0 for group, own in numbers.items()}
    counts = {
        group: (max(own) - 1 - before[group]) * width + own[max(own)]
        for group, own in numbers.items()
    }
    return FixedShape(counts, before, surplus=_SURPLUS, forgettable=True)


def _joined(complete: list[Complete]) -> list[Complete]:
    """Cycles of one layout that follow each other, as one."""
    runs = groupby(complete, key=attrgetter("counts"))
    return [Complete(counts, np.concatenate([each.rows for each in run])) for counts, run in runs]
