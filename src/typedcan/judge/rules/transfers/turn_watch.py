"""Watches frames that take turns, whatever they are."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.rule import Watcher
from typedcan.judge.rules.transfers.turn_order import NO_ROWS, Learner, Rows, TurnOrder
from typedcan.judge.rules.transfers.turns import Fault, Kind, Turns
from typedcan.report.language import Text

_TAIL = 1024
"""Frames that are kept, to find the last one of a key: more than two cycles of 18 x 20."""


class TurnWatcher(Watcher):
    """Says which frames do not keep to their turn.

    Their order is learnt from the first of them, which are judged then, and learnt anew after a
    pause, since what comes after it may be another pack.

    Parameters
    ----------
    node
        Whose frames they are.
    pause
        Seconds without a frame that cut a cycle off.
    texts
        What to say of which faults; the others are passed over.
    """

    def __init__(
        self, findings: Findings, *, node: str, pause: float, texts: Mapping[Kind, Text]
    ) -> None:
        super().__init__(findings)
        self._node = node
        self._pause = pause
        self._texts = texts
        self._learner = self._new_learner()
        self._turns: Turns | None = None
        self._tail = NO_ROWS

    def feed(self, chunk: Chunk) -> None:
        """Judge the frames whose turn is known."""
        new = self._new_rows(chunk)
        if not len(new.keys):
            if self._cuts(chunk, new).any():
                self._begin_anew()
            return
        cuts = self._cuts(chunk, new)
        cuts[1:-1] |= np.diff(new.times) > self._pause
        cuts[0] |= new.times[0] - self._tail.times[-1:].max(initial=-np.inf) > self._pause
        begin = 0
        for end in np.flatnonzero(cuts).tolist():
            self._take_part(new, begin, end)
            self._begin_anew()
            begin = end
        self._take_part(new, begin, len(new.keys))
        self._tail = (new if len(new.keys) >= _TAIL else new.behind(self._tail)).last(_TAIL)

    def _begin_anew(self) -> None:
        self._learner, self._turns = self._new_learner(), None

    def _take_part(self, rows: Rows, begin: int, end: int) -> None:
        """Judge rows that nothing cuts off from each other."""
        while begin < end:
            if self._turns is None:
                self._learn(rows, begin)
                begin += 1
            else:
                begin = self._follow(self._turns, rows, begin, end, self._tail)

    def _learn(self, rows: Rows, row: int) -> None:
        key, time, order = int(rows.keys[row]), float(rows.times[row]), int(rows.orders[row])
        cycle = self._learner.see(key, time, order)
        if cycle is None:
            return
        if cycle.unsorted is not None:
            self._say(Fault(Kind.UNSORTED, cycle.unsorted, time, order, len(cycle)))
        self._begin(cycle, self._learner.rows)

    def _begin(self, cycle: TurnOrder, rows: Rows) -> None:
        """Judge the frames in which the order was found."""
        first = int(np.isin(rows.keys, cycle.keys).argmax())
        self._turns = Turns(cycle, int(rows.keys[first]), self.findings)
        row = first + 1
        while row < len(rows.keys) and self._turns is not None:
            row = self._follow(self._turns, rows, row, len(rows.keys), NO_ROWS)

    def _follow(self, turns: Turns, rows: Rows, begin: int, end: int, before: Rows) -> int:
        stop, faults = turns.follow(rows, begin, end, before)
        self.findings.examine(self._node, stop - begin)
        for fault in faults:
            self._say(fault)
        if turns.is_outdated:
            self._begin_anew()
        return stop

    def _say(self, fault: Fault) -> None:
        if fault.kind not in self._texts:
            return
        found = Occurrence(
            subject=self._subject(fault.key),
            start=fault.time,
            end=fault.time,
            order=fault.order,
            text=self._texts[fault.kind],
            values={"size": fault.size},
        )
        self.findings.add(found)

    @abstractmethod
    def _new_learner(self) -> Learner:
        """What finds the order."""

    @abstractmethod
    def _new_rows(self, chunk: Chunk) -> Rows:
        """The frames of a chunk in their order."""

    def _cuts(self, chunk: Chunk, new: Rows) -> NDArray[np.bool_]:  # noqa: ARG002
        """Before which frames, or after the last one, something else cuts them off."""
        return np.zeros(len(new.keys) + 1, np.bool_)

    @abstractmethod
    def _subject(self, key: int) -> Subject:
        """What the frames with a key are."""
