"""A signal keeps its name."""

from __future__ import annotations

from dbcspec.compare.promise import Breaks, Class, Promise, in_signals

PROMISE = Promise(
    "signal-name-same",
    "A signal on the same bits of the same identifier is called the same in code.",
    Class.SOURCE,
    Breaks.BOTH,
    in_signals("name", lambda signal: signal.name),
)
