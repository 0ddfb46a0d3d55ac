"""A recording that conforms, altered in one place for each rule, flips the right verdicts only."""

from __future__ import annotations

import pytest
from rules.alterations import ALTERATIONS, CSCS, PLAN, SECONDS
from rules.in_blocks import broken, judged_by_all
from rules.recorded import recorded

from swapcan.conform import RULES

OVER_LONGER_TIMES = {"energy-follows-power", "node-awake", "soc-follows-current"}
"""Rules that judge longer times only; their case folders show what they find."""


def test_nothing_is_found_in_what_is_not_altered() -> None:
    assert broken(judged_by_all(recorded(PLAN, seconds=SECONDS, cscs=CSCS))) == set()


@pytest.mark.parametrize("rule", ALTERATIONS)
def test_an_alteration_is_found_by_its_rule_and_by_no_unrelated_one(rule: str) -> None:
    alter, others = ALTERATIONS[rule]
    assert broken(judged_by_all(alter(recorded(PLAN, seconds=SECONDS, cscs=CSCS)))) == {
        rule,
        *others,
    }


def test_every_rule_has_its_alteration() -> None:
    assert ALTERATIONS.keys() | OVER_LONGER_TIMES == {rule.id for rule in RULES}
    assert not ALTERATIONS.keys() & OVER_LONGER_TIMES
