"""How a loaded truck drives: what power it takes to follow a speed, and what comes back."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

Profile = Callable[[float], float]
"""Seconds since the start of the drive to the speed wanted, in km/h."""

_MASS = 42_000.0
"""kg, loaded."""
_ROLLING = 0.0065
"""Resistance of the tyres, a part of the weight."""
_AIR = 0.5 * 1.2 * 5.8
"""Half the density of air times the drag area: N for each m²/s²."""
_GRAVITY = 9.81
_EFFICIENCY = 0.9
"""Of motor and inverter, either way."""
_AUXILIARIES = 5_000.0
"""W, as long as there is high voltage."""
_ACCELERATION = 0.5
_BRAKING = 1.0
_EMERGENCY_BRAKING = 4.0
"""m/s²."""


def shuttle(elapsed: float) -> float:
    """The usual drive: up to 50 km/h and back to a stop, once a minute."""
    return 50.0 if elapsed % 60 < 40 else 0.0


class Power(NamedTuple):
    """What the battery can give and take, in W, neither of them negative."""

    out: float
    back: float


@dataclass(slots=True)
class Trip:
    """A drive: the speed to follow, from the first time that it is asked for, for so long."""

    profile: Profile
    seconds: float
    began: float | None = None

    def wanted(self, now: float) -> float | None:
        """The speed to have now, in km/h; None once the drive is over."""
        if self.began is None:
            self.began = now
        elapsed = now - self.began
        return self.profile(elapsed) if elapsed < self.seconds else None


@dataclass(slots=True)
class Motion:
    """The truck on a flat road; ``speed`` is in m/s."""

    speed: float = 0.0

    @property
    def kmh(self) -> float:
        """The speed in km/h."""
        return 3.6 * self.speed

    def drive(self, passed: float, wanted: float, limit: Power) -> float:
        """Follow a speed in km/h for so many seconds, as fast as the battery lets it.

        Returns the power that the battery gives meanwhile, in W, negative where it takes.
        """
        difference = wanted / 3.6 - self.speed
        acceleration = min(max(difference, -_BRAKING), _ACCELERATION)
        resistance = self._resistance()
        available = max(0.0, limit.out - _AUXILIARIES) * _EFFICIENCY
        if self.speed > 0.1:
            acceleration = min(acceleration, (available / self.speed - resistance) / _MASS)
        at_wheels = (_MASS * acceleration + resistance) * self.speed
        power = at_wheels / _EFFICIENCY if at_wheels > 0 else at_wheels * _EFFICIENCY
        self._go(passed, acceleration)
        # What the battery cannot take goes into the other brakes.
        return min(max(power + _AUXILIARIES, -limit.back), limit.out)

    def brake(self, passed: float) -> None:
        """Come to a stop without the battery."""
        self._go(passed, -_EMERGENCY_BRAKING)

    def _resistance(self) -> float:
        return math.copysign(_MASS * _GRAVITY * _ROLLING, self.speed) + _AIR * self.speed**2

    def _go(self, passed: float, acceleration: float) -> None:
        self.speed = max(0.0, self.speed + acceleration * passed)
        if self.speed < 0.05 and acceleration < 0:
            self.speed = 0.0
