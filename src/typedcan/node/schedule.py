"""Which message is due when: the timetable of a node, without clocks, threads or a bus."""

from __future__ import annotations

import math
from dataclasses import dataclass

from typedcan.wire.message import Message

_SPREAD = 0.1
"""Seconds over which the first transmissions are spread, unless a period is shorter."""

_GOLDEN = (math.sqrt(5) - 1) / 2
"""Its multiples modulo 1 keep far from each other, however many there are."""


@dataclass(slots=True)
class _Cycle:
    """The rhythm of one message.

    The cycle under way began at ``start``, has ``count`` frames and goes on with number ``index``
    at ``due``.
    """

    period: float
    start: float
    due: float
    count: int = 1
    index: int = 0

    def go_on(self, now: float) -> None:
        """The frame that was due is on its way at ``now``; find out when the next one is."""
        spacing = self.period / self.count
        self.index += 1
        if self.index < self.count:
            # Frames that a stall held up come closer together, yet never all at once.
            self.due = max(self.start + self.index * spacing, now + spacing / 2)
            return
        self.index = 0
        self.start += self.period
        late = now - self.start - (self.period - spacing)
        if late > 0:
            self.start += math.ceil(late / self.period) * self.period
        self.due = max(self.start, now + spacing / 2) if self.count > 1 else self.start


class Schedule:
    """The cyclic messages of a node and when the next frame of each is due.

    All times are seconds of one clock, handed in. A cycle begins a period after the one before,
    however late frames went out, so nothing drifts; cycles that a stall left out are skipped, not
    made up for.

    Parameters
    ----------
    phase
        Where the first transmissions of this schedule begin within their spread, 0 to 1.
    """

    def __init__(self, phase: float = 0.0) -> None:
        self._cycles: dict[type[Message], _Cycle] = {}
        self._phase = phase

    def __contains__(self, kind: object) -> bool:
        return kind in self._cycles

    @property
    def next_due(self) -> float:
        """When the next frame is due; `math.inf` where none is."""
        return min((cycle.due for cycle in self._cycles.values()), default=math.inf)

    def add(self, kind: type[Message], period: float, now: float) -> None:
        """Begin a message shortly after ``now``; one that runs keeps its rhythm.

        Another ``period`` holds from the next frame on. Raises `ValueError` where it is none.
        """
        if not 0 < period < math.inf:
            raise ValueError(f"{kind.NAME}: a period is a positive number of seconds, not {period}")
        cycle = self._cycles.get(kind)
        if cycle is None:
            start = now + self._next_phase() * min(period, _SPREAD)
            self._cycles[kind] = _Cycle(period, start, start)
        elif cycle.period != period:
            cycle.start = cycle.due - cycle.index * period / cycle.count
            cycle.period = period

    def resume(self, kind: type[Message], period: float, due: float) -> None:
        """Begin a message, or go on with it, so that its next cycle begins at ``due``."""
        self._cycles[kind] = _Cycle(period, due, due)

    def remove(self, kind: type[Message]) -> None:
        """Forget a message, if it is there."""
        self._cycles.pop(kind, None)

    def restart(self, now: float) -> None:
        """Begin all messages anew, shortly after ``now``."""
        kinds = [(kind, cycle.period) for kind, cycle in self._cycles.items()]
        self._cycles.clear()
        for kind, period in kinds:
            self.add(kind, period, now)

    def postpone(self, kind: type[Message], seconds: float) -> None:
        """Let the next frame come so much later; those after it keep their times."""
        self._cycles[kind].due += seconds

    def due(self, now: float) -> tuple[type[Message], int] | None:
        """The message that has been due for longest, and the number of its frame from 0."""
        first = min(self._cycles.items(), key=lambda item: item[1].due, default=None)
        if first is None or first[1].due > now:
            return None
        return first[0], first[1].index

    def went(self, kind: type[Message], count: int, now: float) -> None:
        """A frame of a cycle of ``count`` frames went out at ``now``: go on to the next one.

        A ``count`` of 0 leaves the cycle out.
        """
        cycle = self._cycles.get(kind)
        if cycle:
            cycle.count = max(count, 1)
            cycle.go_on(now)

    def _next_phase(self) -> float:
        self._phase = (self._phase + _GOLDEN) % 1
        return self._phase
