"""Findings as JUnit XML: every rule is a test, and fails where it has findings."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Sequence

from typedcan.report.item import Item, Report, RuleInfo
from typedcan.report.paths import slashed
from typedcan.report.texts import gravest, plural, purposes, sentence
from typedcan.shell.printing import printable


def to_junit(report: Report) -> str:
    """A suite with a case for every rule of the report, broken or not."""
    found: dict[str, list[Item]] = {rule.id: [] for rule in report.rules}
    for item in report.items:
        found.setdefault(item.rule, []).append(item)
    rules = {rule.id: rule for rule in report.rules}
    why = purposes(report)
    totals = {
        "tests": str(len(found)),
        "failures": str(sum(map(bool, found.values()))),
        "errors": "0",
        "time": "0",
    }
    suites = ET.Element("testsuites", totals)
    suite = ET.SubElement(
        suites, "testsuite", {"name": printable(report.title), **totals, "skipped": "0"}
    )
    for rule, items in found.items():
        _case(
            suite, rules.get(rule) or RuleInfo(rule, "", items[0].level), why.get(rule, ""), items
        )
    ET.indent(suites)
    body = ET.tostring(suites, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{body}\n'


def _case(suite: ET.Element, rule: RuleInfo, why: str, items: Sequence[Item]) -> None:
    # Class and name say which case it is from one run to the next: nothing else is in them.
    case = ET.SubElement(
        suite,
        "testcase",
        {"classname": f"dbcspec.{rule.level}", "name": printable(rule.id), "time": "0"},
    )
    if not items:
        return
    if items[0].where.path:
        case.set("file", printable(slashed(items[0].where.path)))
    against = f" against: {why}" if why else ""
    failure = ET.SubElement(
        case,
        "failure",
        {
            "message": printable(f"{plural(len(items), 'finding')}{against}"),
            "type": gravest(items),
        },
    )
    failure.text = "\n".join(map(_line, items))


def _line(item: Item) -> str:
    where = f"{item.where}: " if item.where.path else ""
    return printable(where) + sentence(item)
