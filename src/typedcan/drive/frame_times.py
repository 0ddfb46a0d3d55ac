"""The times of received frames, as the system has them: some adapters have their own clock."""

from __future__ import annotations

import math
import time

import can

from typedcan.node.clock import Clock, SystemClock

_NO_TIME = 3600.0
"""Seconds between an adapter's time and the system's, as they were at first, that cannot be."""

_OTHER_TIME = 1.0
"""Seconds between the adapter's time and the system's from which on they count as different."""

_LATEST = 2.0**32
"""Seconds that no adapter counts up to, whatever it counts from."""


class FrameTimes:
    """Puts the times of a bus beside those of a clock."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._wall = time.time() - clock.now() if isinstance(clock, SystemClock) else 0.0
        self._shift: float | None = None
        self._lag = math.inf  # the least that a frame has been late by its own time

    def sent(self) -> float:
        """The time of what is sent now, as the adapter would have it.

        Else an answer might come before what it answers.
        """
        return self._now() - (self._lag if math.isfinite(self._lag) else 0.0)

    def received(self, frame: can.Message) -> float:
        """The time of a received frame."""
        now = self._now()
        if not 0 < frame.timestamp < _LATEST:  # nor where it is not a number
            return now
        if self._shift is None:
            shift = now - frame.timestamp
            self._shift = shift if abs(shift) > _OTHER_TIME else 0.0
        moment = frame.timestamp + self._shift
        if abs(moment - now) > _NO_TIME:
            return now
        self._lag = min(self._lag, now - moment)
        return moment

    def _now(self) -> float:
        return self._wall + self._clock.now()
