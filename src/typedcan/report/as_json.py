"""Findings for programs; report.schema.json beside this file describes the shape."""

from __future__ import annotations

from typedcan.report.item import LEVELS, Item, Report
from typedcan.report.texts import dump

VERSION = 1
"""Rises when a reader of the shape must change; new keys alone do not raise it."""


def to_json(report: Report) -> str:
    """The findings with every field whole and unchanged, in the order of the report."""
    counts = report.counts()
    return dump(
        {
            "version": VERSION,
            "title": report.title,
            "notes": list(report.notes),
            "counts": {level: counts.get(level, 0) for level in LEVELS},
            "findings": [_finding(item) for item in report.items],
        }
    )


def _finding(item: Item) -> dict[str, object]:
    return {
        "rule": item.rule,
        "level": item.level,
        "group": item.group,
        "subject": item.subject,
        "text": item.text,
        "breaks": item.breaks,
        "old": item.old,
        "new": item.new,
        "members": list(item.members),
        "path": item.where.path,
        "line": item.where.line,
        "column": item.where.column,
        "fingerprint": item.fingerprint,
    }
