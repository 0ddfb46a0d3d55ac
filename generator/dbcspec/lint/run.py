"""Runs rules over a subject and takes the waivers into account."""

from __future__ import annotations

import dataclasses
from collections.abc import Collection, Sequence
from fnmatch import fnmatchcase

from dbcspec.lint.options import Options
from dbcspec.lint.rule import Finding, Rule, Subject, Waiver
from dbcspec.lint.waiver_used import RULE as WAIVER_USED


def lint_with(subject: Subject, options: Options) -> list[Finding]:
    """All findings under a configuration, in order of place."""
    subject = dataclasses.replace(subject, settings=options.settings)
    return lint(subject, options.waivers, options.rules())


def lint(
    subject: Subject,
    waivers: Sequence[Waiver] = (),
    rules: Collection[Rule] = Options().rules(),
) -> list[Finding]:
    """All findings of the rules that no waiver accepts, in order of place.

    A waiver that accepts nothing is a finding itself, unless its rule did not run, or another
    reading or edition is looked at than the usual one, which may need fewer.
    """
    used: set[Waiver] = set()
    left: list[Finding] = []
    for rule in rules:
        for finding in rule.findings(subject):
            accepted = [waiver for waiver in waivers if _accepts(waiver, finding)]
            used.update(accepted)
            if not accepted:
                left.append(finding)
    if WAIVER_USED in rules and not subject.protocol.chosen:
        ran = {rule.id for rule in rules}
        unused = tuple(each for each in waivers if each not in used and each.rule in ran)
        left += WAIVER_USED.findings(dataclasses.replace(subject, unused_waivers=unused))
    return sorted(left)


def _accepts(waiver: Waiver, finding: Finding) -> bool:
    return (
        waiver.rule == finding.rule
        and fnmatchcase(finding.subject, waiver.subject)
        and fnmatchcase(finding.message, waiver.message)
    )
