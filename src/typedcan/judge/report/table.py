"""Occurrences as CSV, a row each, and rules that were not judged, for spreadsheets."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence

from typedcan.judge.findings import Occurrence
from typedcan.judge.judgement import Judgement, RuleResult
from typedcan.judge.report import facts, figures
from typedcan.judge.rule import Severity
from typedcan.report.language import Language
from typedcan.shell.printing import printable

COLUMNS = (
    "log",
    "rule",
    "severity",
    "clause",
    "node",
    "message",
    "signal",
    "detail",
    "start",
    "end",
    "start_utc",
    "order",
    "frames",
    "measure",
    "text",
    "status",
)
"""The names in the first row; times are seconds since the log's begin."""

_FORMULA = ("=", "+", "-", "@")


def to_csv(judgements: Sequence[Judgement], language: Language) -> str:
    """The table: a row of names, then one per occurrence that is kept, or rule not judged.

    The row of a rule that was not judged has the reason as its ``text``, and no place or time.

    ``start_utc`` is empty where the log's times are no dates. A text that a spreadsheet would
    take for a formula has an apostrophe before it.
    """
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(COLUMNS)
    for judgement in judgements:
        for result in judgement.results:
            writer.writerows(_rows(judgement, result, language))
    return out.getvalue()


def _rows(judgement: Judgement, result: RuleResult, language: Language) -> Iterator[list[str]]:
    rule = result.rule
    clause = facts.clause(rule, language)
    for found in result.occurrences:
        severity = min(rule.severity, Severity.SHOULD) if found.is_open else rule.severity
        head = (judgement.log, rule.id, severity.name.lower(), clause)
        yield [
            *map(_cell, (*head, *found.subject)),
            *_figures(judgement.begin, found),
            _cell(facts.says(found, language)),
            result.status.name.lower(),
        ]
    if reason := facts.reason(judgement, result, language):
        row = dict.fromkeys(COLUMNS, "") | {
            "log": _cell(judgement.log),
            "rule": _cell(rule.id),
            "severity": rule.severity.name.lower(),
            "clause": _cell(clause),
            "text": _cell(reason),
            "status": result.status.name.lower(),
        }
        yield list(row.values())


def _figures(begin: float, found: Occurrence) -> list[str]:
    return [
        f"{found.start:.6f}",
        f"{found.end:.6f}",
        figures.utc(begin + found.start) if figures.utc(begin) else "",
        str(found.order),
        str(found.frames),
        f"{found.measure:.9g}",
    ]


def _cell(text: str) -> str:
    seen = printable(text)
    return f"'{seen}" if seen.startswith(_FORMULA) else seen
