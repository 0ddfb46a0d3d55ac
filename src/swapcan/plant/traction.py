"""What a truck draws from its pack, guessed from the speed that it tells."""

from __future__ import annotations

import math

_REFERENCE_SPEED = 60.0  # km/h
_IDLE = 0.01  # current of what always runs, as a multiple of the capacity
_ROLLING = 0.22  # the same for rolling at the reference speed,
_AIR = 0.10  # for the air there,
_ACCELERATING = 1.2  # and for each m/s2 there
_SPEED_TIME = 1.0  # s, over which the speed's whole km/h are smoothed
_CURRENT_TIME = 0.2  # s, in which the current follows


class Traction:
    """The current of a truck; ``current`` is in A, discharging positive."""

    def __init__(self) -> None:
        self.current = 0.0
        self._speed = 0.0

    def advance(
        self, dt: float, speed: float, *, on: bool, capacity: float, limits: tuple[float, float]
    ) -> None:
        """Let so many seconds pass.

        Parameters
        ----------
        dt, speed
            In seconds and km/h.
        on
            Whether the truck may draw current.
        capacity
            Of the pack in Ah, as the truck's power is taken to go with it.
        limits
            Of charging and discharging, in A, both positive.
        """
        rate = (speed - self._speed) / _SPEED_TIME
        self._speed += rate * min(dt, _SPEED_TIME)
        share = self._speed / _REFERENCE_SPEED
        power = _IDLE + _ROLLING * share + _AIR * share**3 + _ACCELERATING * share * rate / 3.6
        charge, discharge = limits
        goal = min(discharge, max(-charge, power * capacity)) if on else 0.0
        self.current = goal + (self.current - goal) * math.exp(-dt / _CURRENT_TIME)
