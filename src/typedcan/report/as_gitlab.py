"""Findings as a Code Quality report, which GitLab shows in a merge request."""

from __future__ import annotations

import hashlib
from collections import Counter

from typedcan.report.item import Item, Report
from typedcan.report.paths import slashed
from typedcan.report.texts import dump, sentence

_SEVERITIES = {
    "error": "major",
    "warning": "minor",
    "note": "info",
    "wire": "critical",
    "source": "major",
    "additive": "minor",
    "cosmetic": "info",
}


def to_gitlab(report: Report) -> str:
    """A list of issues; one without a place of its own is shown at the project's folder."""
    seen: Counter[str] = Counter()
    issues = []
    for item in report.items:
        issues.append(_issue(item, seen[item.fingerprint]))
        seen[item.fingerprint] += 1
    return dump(issues)


def _issue(item: Item, repeated: int) -> dict[str, object]:
    # GitLab shows one issue of a fingerprint only.
    fingerprint = hashlib.sha256(f"{item.fingerprint} {repeated}".encode()).hexdigest()
    return {
        "description": sentence(item),
        "check_name": item.rule,
        "fingerprint": fingerprint,
        "severity": _SEVERITIES[item.level],
        "location": {
            "path": slashed(item.where.path) or ".",
            "lines": {"begin": item.where.line},
        },
    }
