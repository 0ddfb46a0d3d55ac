"""A signal keeps its length."""

from __future__ import annotations

from dbcspec.compare.promise import Breaks, Class, Promise, in_signals

PROMISE = Promise(
    "signal-length-same",
    "A signal keeps its number of bits.",
    Class.WIRE,
    Breaks.BOTH,
    in_signals("length", lambda signal: signal.length, lambda length: f"{length} bits"),
)
