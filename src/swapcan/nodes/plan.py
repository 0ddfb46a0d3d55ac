"""What simulated participants are told to do, and when."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from typedcan.simulate.times import PlanError, timed


@dataclass(frozen=True, slots=True)
class StepKind:
    """Something that a participant can be told: its name, who is told, and what in one line."""

    name: str
    node: str
    text: str


STEPS: Mapping[str, StepKind] = MappingProxyType(
    {
        kind.name: kind
        for kind in (
            StepKind("hv_on", "VCU", "the truck commands high voltage on"),
            StepKind("drive", "VCU", "the truck drives, for a time where one is given"),
            StepKind("stop", "VCU", "the truck brakes to a stop"),
            StepKind("hv_off", "VCU", "the truck stops and commands high voltage off"),
            StepKind("ask", "VCU", "the truck asks for pack code and basic data"),
            StepKind("charge", "CHG", "the charger is connected, for a time where one is given"),
            StepKind("unlock", "BSU", "the pack is unlocked, for a time where one is given"),
        )
    }
)
"""All steps by name."""


@dataclass(frozen=True, slots=True)
class PlannedStep:
    """A step, the second it is taken, and how long it lasts where it ends by itself."""

    name: str
    start: float
    duration: float = math.inf

    @property
    def node(self) -> str:
        """Who takes it."""
        return STEPS[self.name].node

    @property
    def end(self) -> float:
        """When it ends, in seconds from the beginning of the run."""
        return self.start + self.duration

    def __str__(self) -> str:
        duration = f"+{self.duration:g}s" if math.isfinite(self.duration) else ""
        return f"{self.name}@{self.start:g}s{duration}"


def planned_step(text: str) -> PlannedStep:
    """A step from ``NAME@START`` or ``NAME@START+DURATION``; raises `PlanError`."""
    name, start, duration = timed(text, "hv_on@1s")
    if name not in STEPS:
        raise PlanError(f"there is no step {name!r}; known: {', '.join(STEPS)}")
    return PlannedStep(name, start, math.inf if duration is None else duration)


def plan_of(text: str) -> tuple[PlannedStep, ...]:
    """The steps of a text such as ``hv_on@1s, drive@3s+30s, hv_off@40s``; raises `PlanError`."""
    return tuple(planned_step(part) for part in text.split(",") if part.strip())


DEFAULT_PLAN = plan_of("hv_on@1s, ask@2s, drive@3s+40s, charge@50s+60s, hv_off@120s")
"""On, a drive, a charge, off."""
