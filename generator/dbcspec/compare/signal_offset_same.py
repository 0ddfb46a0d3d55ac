"""A signal keeps its offset."""

from __future__ import annotations

from dbcspec.compare.promise import Breaks, Class, Promise, in_signals
from typedcan.model.numbers import number

PROMISE = Promise(
    "signal-offset-same",
    "Raw 0 of a signal keeps its physical value.",
    Class.WIRE,
    Breaks.BOTH,
    in_signals("offset", lambda signal: signal.offset, number),
)
