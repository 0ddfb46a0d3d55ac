"""Findings as SARIF 2.1.0, the interchange format of static analysis; § are its sections."""

from __future__ import annotations

from collections.abc import Mapping

from typedcan.report.item import Item, Report, RuleInfo
from typedcan.report.paths import is_absolute, slashed, uri
from typedcan.report.texts import MEANINGS, dump, purposes, sentence
from typedcan.shell.printing import printable

_LEVELS = {
    "error": "error",
    "warning": "warning",
    "note": "note",
    "wire": "error",
    "source": "warning",
    "additive": "note",
    "cosmetic": "note",
}
_FINGERPRINT = "dbcspecFinding/v1"


def to_sarif(report: Report) -> str:
    """One run with every rule of the report, broken or not, and a result for each finding."""
    places = {rule.id: index for index, rule in enumerate(report.rules)}
    why = purposes(report)
    rules = [_rule(rule, why[rule.id]) for rule in report.rules]
    run = {
        "tool": {"driver": {"name": "dbcspec", "rules": rules}},
        "columnKind": "unicodeCodePoints",
        "results": [_result(item, places) for item in report.items],
    }
    return dump(
        {
            "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
            "version": "2.1.0",
            "runs": [run],
        }
    )


def _message(text: str) -> str:
    """§3.11.5: braces mark placeholders, so literal ones are doubled."""
    return text.replace("{", "{{").replace("}", "}}")


def _rule(rule: RuleInfo, purpose: str) -> dict[str, object]:
    described = printable(purpose) or rule.id
    return {
        "id": rule.id,
        "shortDescription": {"text": described},
        "fullDescription": {"text": described},
        "help": {"text": f"{described} Level {rule.level}: {MEANINGS[rule.level]}."},
        "defaultConfiguration": {"level": _LEVELS[rule.level]},
        "properties": {"tags": [rule.level]},
    }


def _result(item: Item, places: Mapping[str, int]) -> dict[str, object]:
    result: dict[str, object] = {
        "ruleId": item.rule,
        "level": _LEVELS[item.level],
        "message": {"text": _message(sentence(item)) or item.rule},
        "locations": [_location(item)],
        "partialFingerprints": {_FINGERPRINT: item.fingerprint},
        "properties": {
            "class": item.level,
            "breaks": item.breaks,
            "old": item.old,
            "new": item.new,
        },
    }
    if item.rule in places:
        result["ruleIndex"] = places[item.rule]
    return result


def _location(item: Item) -> dict[str, object]:
    names = [name for name in dict.fromkeys((item.group, item.subject)) if name]
    location: dict[str, object] = {}
    if names:
        location["logicalLocations"] = [
            {"name": printable(names[-1]), "fullyQualifiedName": printable(".".join(names))}
        ]
    if path := item.where.path:
        artifact = {"uri": uri(path)}
        if not is_absolute(slashed(path)):
            artifact["uriBaseId"] = "%SRCROOT%"
        location["physicalLocation"] = {
            "artifactLocation": artifact,
            "region": {"startLine": item.where.line, "startColumn": item.where.column},
        }
    return location
