"""A tolerance: how far from what is printed still counts as right."""

from __future__ import annotations

from dataclasses import dataclass

from typedcan.report.language import Text


@dataclass(frozen=True, slots=True, kw_only=True)
class Tolerance:
    """A limit that a rule holds against what it measures.

    Parameters
    ----------
    name
        The id of its rule, a dot and a word, such as ``period-mean.share``; unique.
    value, unit
        The limit where none is given for a run, and its unit; a share has none.
    text
        What is allowed, in one line.
    """

    name: str
    value: float
    unit: str = ""
    text: Text
