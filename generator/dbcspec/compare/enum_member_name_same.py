"""A code keeps the name that generated code gives it."""

from __future__ import annotations

from dbcspec.compare.codes import Difference, differing_in
from dbcspec.compare.promise import Breaks, Class, Promise

PROMISE = Promise(
    "enum-member-name-same",
    "A code that means the same is called the same in code.",
    Class.SOURCE,
    Breaks.BOTH,
    differing_in(Difference.MEMBER, "name of code", lambda _, member: member),
)
