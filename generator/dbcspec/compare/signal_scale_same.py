"""A signal keeps its factor."""

from __future__ import annotations

from dbcspec.compare.promise import Breaks, Class, Promise, in_signals
from typedcan.model.numbers import number

PROMISE = Promise(
    "signal-scale-same",
    "One raw step of a signal keeps its physical value.",
    Class.WIRE,
    Breaks.BOTH,
    in_signals("factor", lambda signal: signal.factor, number),
)
