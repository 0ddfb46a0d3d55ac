"""What the time is: the system's clock, or one that a simulation sets."""

from __future__ import annotations

import time
from typing import Protocol


class Clock(Protocol):
    """Seconds since some moment; they never go back."""

    def now(self) -> float:
        """Seconds."""
        ...


class SystemClock:
    """Real time, as fine as the system has it."""

    def now(self) -> float:
        """Seconds since some moment of the system's."""
        return time.perf_counter()


class SimulatedClock:
    """A time that stands still until it is set."""

    def __init__(self, now: float = 0.0) -> None:
        self._now = now

    def now(self) -> float:
        """Seconds since the simulation began."""
        return self._now

    def advance_to(self, now: float) -> None:
        """Go on to a later time; raises `ValueError` where it is earlier."""
        if now < self._now:
            raise ValueError(f"time cannot go back from {self._now:g} s to {now:g} s")
        self._now = now
