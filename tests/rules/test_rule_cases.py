"""Each rule on its case folder: ``passes.log`` breaks nothing, ``fails.log`` what is expected."""

from __future__ import annotations

import pkgutil
import re
from importlib import import_module
from pathlib import Path

import pytest
from rules.in_blocks import ALL, result_of

import swapcan.rules
import typedcan.judge.rules
from swapcan._generated.protocol import PROTOCOL
from swapcan.conform import RULES, Judgement, Rule, RuleResult, Status, judge_log
from swapcan.rules import SCOPE
from typedcan.judge.rules import rules_for
from typedcan.judge.tolerance import SHARED, Tolerance

CASES = Path(__file__).with_name("cases")

over_all_rules = pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.id)


def result(rule: Rule, log: str) -> RuleResult:
    """What one rule finds in a log of its case folder."""
    judgement: Judgement = judge_log(CASES / rule.id / log, rules=[rule])
    assert judgement.damage == ()
    return judgement.result(rule.id)


def lines(found: RuleResult) -> list[str]:
    """The occurrences as expected.txt has them: when, how many frames, who, about what, what."""
    return [
        f"{each.start:.3f} to {each.end:.3f} s, frames: {each.frames}: "
        f"{each.subject.node}: {each.subject}: {each.says()}"
        for each in found.occurrences
    ]


@over_all_rules
def test_a_rule_finds_what_is_expected(rule: Rule) -> None:
    expected = (CASES / rule.id / "expected.txt").read_text("utf-8").splitlines()
    assert expected
    assert lines(result(rule, "fails.log")) == expected


@over_all_rules
def test_a_rule_passes_a_near_miss_that_it_has_examined(rule: Rule) -> None:
    found = result(rule, "passes.log")
    assert lines(found) == []
    assert found.status is Status.PASSED


@over_all_rules
def test_a_rule_says_the_same_in_chinese(rule: Rule) -> None:
    for each in result(rule, "fails.log").occurrences:
        assert re.search(r"[\u4e00-\u9fff]", each.says("zh"))
    for text in (rule.title, rule.purpose, *(each.text for each in rule.tolerances)):
        assert re.search(r"[\u4e00-\u9fff]", text.zh)


@pytest.mark.parametrize("size", [1, 7])
@pytest.mark.parametrize("log", ["passes.log", "fails.log"])
@over_all_rules
def test_a_rule_finds_the_same_wherever_a_log_is_cut(rule: Rule, log: str, size: int) -> None:
    whole, cut = (result_of(rule, CASES / rule.id / log, frames) for frames in (ALL, size))
    assert lines(cut) == lines(whole)
    assert (cut.examined, cut.count, cut.frames) == (whole.examined, whole.count, whole.frames)


def test_every_rule_has_a_case_folder_and_every_folder_a_rule() -> None:
    assert {path.name for path in CASES.iterdir()} == {rule.id for rule in RULES}


def test_every_module_with_a_rule_is_registered_under_the_name_of_its_file() -> None:
    modules = {
        info.name.rpartition(".")[2]: import_module(info.name)
        for folder in (swapcan.rules, typedcan.judge.rules)
        for info in pkgutil.walk_packages(folder.__path__, f"{folder.__name__}.")
    }
    own = {name: module.RULE for name, module in modules.items() if hasattr(module, "RULE")}
    made = {name.replace("_", "-") for name, module in modules.items() if hasattr(module, "rule")}
    cycles = {f"{what}-{how}" for what in ("cells", "probes") for how in ("complete", "order")}
    assert {name.replace("_", "-") for name in own} == {rule.id for rule in own.values()}
    assert {rule.id for rule in RULES} == {rule.id for rule in own.values()} | made | cycles
    assert {rule.id for rule in rules_for(PROTOCOL, SCOPE)} == made | cycles


def test_ids_of_rules_and_names_of_tolerances_are_unique() -> None:
    ids = [rule.id for rule in RULES]
    own = [each for rule in RULES for each in rule.tolerances if _is_own(rule, each)]
    shared = {each for rule in RULES for each in rule.tolerances if not _is_own(rule, each)}
    names = [each.name for each in (*own, *shared, *SHARED)]
    assert len(ids) == len(set(ids))
    assert len(names) == len(set(names))
    assert not {name.partition(".")[0] for name in names[len(own) :]} & set(ids)


def _is_own(rule: Rule, tolerance: Tolerance) -> bool:
    return tolerance.name.startswith(f"{rule.id}.")


def test_tolerances_that_rules_share_are_explained_in_both_languages() -> None:
    for each in SHARED:
        assert each.text.en
        assert re.search(r"[\u4e00-\u9fff]", each.text.zh)
