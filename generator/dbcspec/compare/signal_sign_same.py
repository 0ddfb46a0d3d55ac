"""A signal stays signed or unsigned."""

from __future__ import annotations

from dbcspec.compare.promise import Breaks, Class, Promise, in_signals

PROMISE = Promise(
    "signal-sign-same",
    "A signal stays signed or unsigned.",
    Class.WIRE,
    Breaks.BOTH,
    in_signals(
        "sign", lambda signal: signal.signed, lambda signed: "signed" if signed else "unsigned"
    ),
)
