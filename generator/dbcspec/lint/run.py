"""Runs rules over a subject and takes the waivers into account."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence
from fnmatch import fnmatchcase

from dbcspec.lint.registry import RULES
from dbcspec.lint.rule import Finding, Rule, Subject, Waiver
from dbcspec.lint.waiver_used import RULE as WAIVER_USED


def lint(
    subject: Subject, waivers: Sequence[Waiver] = (), rules: Iterable[Rule] = RULES
) -> list[Finding]:
    """All findings that no waiver accepts, in order of place.

    A waiver that accepts nothing is a finding itself.
    """
    used: set[Waiver] = set()
    left: list[Finding] = []
    for rule in rules:
        for finding in rule.findings(subject):
            accepted = [waiver for waiver in waivers if _accepts(waiver, finding)]
            used.update(accepted)
            if not accepted:
                left.append(finding)
    unused = tuple(waiver for waiver in waivers if waiver not in used)
    left += WAIVER_USED.findings(dataclasses.replace(subject, unused_waivers=unused))
    return sorted(left)


def _accepts(waiver: Waiver, finding: Finding) -> bool:
    return waiver.rule == finding.rule and fnmatchcase(finding.subject, waiver.subject)
