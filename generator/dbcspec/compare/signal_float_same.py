"""A signal stays an integer or a float."""

from __future__ import annotations

from dbcspec.compare.promise import Breaks, Class, Promise, in_signals

PROMISE = Promise(
    "signal-float-same",
    "The bits of a signal stay an integer or a floating point number.",
    Class.WIRE,
    Breaks.BOTH,
    in_signals(
        "kind", lambda signal: signal.is_float, lambda is_float: "float" if is_float else "integer"
    ),
)
