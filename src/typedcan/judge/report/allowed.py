"""How far two frames may be apart, as the rules of a judgement have it."""

from __future__ import annotations

from typedcan.judge.judgement import Judgement
from typedcan.judge.report import facts

LEAST, MOST, EXTRA = "period-short.share", "period-gap.share", "period-gap.extra"
"""The tolerances: shares of the printed period, and seconds beside the longest step."""


def allowed_step(judgement: Judgement, period: float) -> tuple[float, float] | None:
    """The shortest and the longest step at a printed period, in seconds.

    None where the rules that limit it are not among those that judged.
    """
    limits = {
        tolerance.name: facts.in_force(judgement, tolerance)
        for result in judgement.results
        for tolerance in result.rule.tolerances
    }
    if not {LEAST, MOST, EXTRA} <= set(limits):
        return None
    return limits[LEAST] * period, limits[MOST] * period + limits[EXTRA]
