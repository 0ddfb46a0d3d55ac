"""Telling of frames in the order of their times, whatever he makes of it who is told."""

from __future__ import annotations

import heapq
import itertools
import math
from collections import deque
from collections.abc import Callable

import can

_BEHIND = 0.1
"""Seconds for which a frame waits for those that came before it and are read after it."""


class InOrder:
    """Frames that wait to be told of.

    Once ``note`` raises it is told no more, and ``failure`` has what it raised: neither a full disk
    nor anything else of a recorder is to hold up who drives a bus.
    """

    def __init__(self, note: Callable[[can.Message], object]) -> None:
        self._note = note
        self._waiting: list[tuple[float, int, can.Message]] = []
        self._aside: deque[tuple[float, can.Message]] = deque()
        self._number = itertools.count()
        self._newest = 0.0
        self.failure: BaseException | None = None

    def take(self, frame: can.Message, moment: float) -> None:
        """A frame of a moment; those that are old enough are told of."""
        self._add(frame, moment)
        self._tell(until=self._newest - _BEHIND)

    def lay_aside(self, frame: can.Message, moment: float) -> None:
        """A frame that is told of with the next one: any thread may, in the middle of anything."""
        self._aside.append((moment, frame))

    def tell_all(self) -> None:
        """Tell of all that waits."""
        self._tell(until=math.inf)

    def _add(self, frame: can.Message, moment: float) -> None:
        frame.timestamp = moment
        frame.channel = None  # else what is sent and what is received would be on two
        heapq.heappush(self._waiting, (moment, next(self._number), frame))
        self._newest = max(self._newest, moment)

    def _tell(self, until: float) -> None:
        while self._aside:
            moment, frame = self._aside.popleft()
            self._add(frame, moment)
        while self._waiting and self._waiting[0][0] <= until:
            frame = heapq.heappop(self._waiting)[2]
            if self.failure is None:
                try:
                    self._note(frame)
                except BaseException as error:  # noqa: BLE001 - recorders raise what they like
                    self.failure = error
