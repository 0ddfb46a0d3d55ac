"""The linter on this project's own spec."""

from __future__ import annotations

import dataclasses

from dbcspec.lint.options import ALL
from dbcspec.lint.registry import ALL_RULES
from dbcspec.lint.rule import Subject
from dbcspec.lint.run import lint_with
from dbcspec.project import Project


def test_the_projects_own_spec_has_only_findings_that_are_waived(project: Project) -> None:
    assert list(map(str, project.findings())) == []


def test_no_rule_at_all_has_a_finding_in_the_own_spec_that_is_not_waived(project: Project) -> None:
    subject = Subject(protocol=project.protocol, spec=project.spec)
    every_rule = dataclasses.replace(project.config.lint, select=(ALL,))
    assert list(map(str, lint_with(subject, every_rule))) == []


def test_rules_find_nothing_more_in_the_model_alone_than_in_model_and_spec(
    project: Project,
) -> None:
    alone = Subject(protocol=project.protocol)
    both = Subject(protocol=project.protocol, spec=project.spec)
    for rule in ALL_RULES:
        found = {(each.subject, each.text) for each in rule.findings(alone)}
        assert found <= {(each.subject, each.text) for each in rule.findings(both)}
