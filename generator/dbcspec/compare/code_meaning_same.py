"""A code keeps its meaning."""

from __future__ import annotations

from dbcspec.compare.codes import Difference, differing_in, quoted
from dbcspec.compare.promise import Breaks, Class, Promise

PROMISE = Promise(
    "code-meaning-same",
    "A raw value means the same.",
    Class.WIRE,
    Breaks.BOTH,
    differing_in(Difference.MEANING, "code", lambda code, _: quoted(code)),
)
