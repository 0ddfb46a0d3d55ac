"""Times as people type them in plans: ``30s``, ``500ms``, ``drive@4s+30s``."""

from __future__ import annotations

import re
from typing import NamedTuple

from typedcan.model.errors import TypedcanError

_UNITS = {"": 1.0, "s": 1.0, "ms": 0.001, "min": 60.0, "h": 3600.0}


class PlanError(TypedcanError, ValueError):
    """Something planned does not exist, or not there, or not at such a time."""


class Timed(NamedTuple):
    """What is to happen, at which second, and for how many; None where that is not said."""

    name: str
    start: float
    duration: float | None


def timed(text: str, example: str) -> Timed:
    """Read ``NAME@START`` or ``NAME@START+DURATION``; raises `PlanError`."""
    name, at, when = (part.strip() for part in text.partition("@"))
    if not (name and at):
        raise PlanError(f"expected NAME@TIME, such as {example}, not {text!r}")
    start, plus, duration = when.partition("+")
    return Timed(name, seconds_of(start), seconds_of(duration) if plus else None)


def seconds_of(text: str) -> float:
    """Seconds from a time such as ``30s``, ``500ms``, ``2min`` or ``30``; raises `PlanError`."""
    match = re.fullmatch(rf"([0-9]+(?:\.[0-9]+)?) ?({'|'.join(_UNITS)})", text.strip())
    if not match:
        raise PlanError(f"expected a time such as 30s, 500ms or 2min, not {text!r}")
    return float(match[1]) * _UNITS[match[2]]
