"""Findings and rules in the form that all reports print."""

from __future__ import annotations

from collections.abc import Iterable

from dbcspec.lint.registry import ALL_RULES
from dbcspec.lint.rule import Finding, Rule
from typedcan.report.item import Item, RuleInfo


def to_items(findings: Iterable[Finding]) -> list[Item]:
    """The findings in their order, each in the group of its message."""
    return [
        Item(
            rule=finding.rule,
            level=finding.level,
            group=finding.message,
            subject=finding.subject,
            text=finding.text,
            where=finding.where,
        )
        for finding in findings
    ]


def rule_infos(rules: Iterable[Rule] = ALL_RULES) -> list[RuleInfo]:
    """The rules as reports describe them, in their order."""
    return [RuleInfo(rule.id, rule.purpose, rule.level) for rule in rules]
