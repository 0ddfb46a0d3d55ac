"""A signal keeps its unit."""

from __future__ import annotations

from dbcspec.compare.promise import Breaks, Class, Promise, in_signals

PROMISE = Promise(
    "signal-unit-same",
    "A signal is measured in the same unit.",
    Class.WIRE,
    Breaks.BOTH,
    in_signals("unit", lambda signal: signal.unit),
)
