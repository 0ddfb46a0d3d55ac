"""A code keeps its label to the letter."""

from __future__ import annotations

from dbcspec.compare.codes import Difference, both_labels, differing_in
from dbcspec.compare.promise import Breaks, Class, Promise

PROMISE = Promise(
    "code-label-same",
    "A code that means the same is labelled the same, to the letter.",
    Class.COSMETIC,
    Breaks.NOBODY,
    differing_in(Difference.LABEL, "label of code", lambda code, _: both_labels(code)),
)
