"""Each rule on its case folders: ``fires`` gives what expected.txt says, ``quiet`` nothing."""

from __future__ import annotations

import dataclasses
import pkgutil
import re
from importlib import import_module
from pathlib import Path

import pytest

import dbcspec.lint
from dbcspec.config import Config, find_config
from dbcspec.fix import raw_text
from dbcspec.lint.options import ALL, Options
from dbcspec.lint.registry import ALL_RULES, RULES
from dbcspec.lint.rule import Rule, Subject
from dbcspec.lint.run import lint_with
from dbcspec.project import load
from typedcan.databases.dbc import read_dbc

CASES = Path(__file__).with_name("cases")

over_all_rules = pytest.mark.parametrize("rule", ALL_RULES, ids=lambda rule: rule.id)


def subject(folder: Path) -> Subject:
    """A case as the linter sees it: a DBC file where there is one, else a spec."""
    dbc = folder / "case.dbc"
    if dbc.is_file():
        name = f"{folder.name}/case.dbc"
        text = raw_text(dbc.read_bytes(), "utf-8")
        return Subject(protocol=read_dbc(dbc, shown_as=name), dbc_text=text, source=name)
    project = load(Config(root=folder.parent, name="case", spec=folder.name))
    return Subject(
        protocol=project.protocol, spec=project.spec, errata_faults=project.errata_faults
    )


def lines(rule: Rule, folder: Path) -> list[str]:
    """The findings of one rule in a case, under the configuration of the case if it has one."""
    configured = (folder / "pyproject.toml").is_file()
    options = find_config(folder).lint if configured else Options()
    findings = lint_with(subject(folder), dataclasses.replace(options, select=(ALL,)))
    return [str(each) for each in findings if each.rule == rule.id]


@over_all_rules
def test_a_rule_fires_with_the_expected_lines(rule: Rule) -> None:
    expected = (CASES / rule.id / "expected.txt").read_text("utf-8").splitlines()
    assert expected
    assert lines(rule, CASES / rule.id / "fires") == expected


@over_all_rules
def test_a_rule_is_quiet_about_a_near_miss(rule: Rule) -> None:
    assert lines(rule, CASES / rule.id / "quiet") == []


def test_every_rule_has_a_case_folder_and_every_folder_a_rule() -> None:
    assert {path.name for path in CASES.iterdir()} == {rule.id for rule in ALL_RULES}


def test_every_module_with_a_rule_is_registered_under_the_name_of_its_file() -> None:
    modules = {
        info.name: import_module(f"dbcspec.lint.{info.name}")
        for info in pkgutil.iter_modules(dbcspec.lint.__path__)
    }
    found = {name: module.RULE for name, module in modules.items() if hasattr(module, "RULE")}
    assert {rule.id for rule in ALL_RULES} == {rule.id for rule in found.values()}
    assert {name.replace("_", "-") for name in found} == {rule.id for rule in found.values()}


def test_rule_ids_are_kebab_case_and_unique() -> None:
    ids = [rule.id for rule in ALL_RULES]
    assert len(ids) == len(set(ids))
    assert all(re.fullmatch(r"[a-z]+(-[a-z]+)+", rule_id) for rule_id in ids)


def test_all_rules_are_the_rules_over_a_subject_and_the_one_over_waivers() -> None:
    assert [rule.id for rule in ALL_RULES if rule not in RULES] == ["waiver-used"]
