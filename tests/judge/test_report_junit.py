"""JUnit XML as an independent reader of it sees it."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import replace

import pytest
from judge.report_samples import EMPTY, GOOD, HOSTILE, PLAIN, hostile
from junitparser import Error, Failure, JUnitXml, Skipped, TestCase, TestSuite

from swapcan.conform import Judgement
from typedcan.judge.report import to_junit


def suites(*judgements: Judgement, strict: bool = False) -> list[TestSuite]:
    text = to_junit(judgements, "en", strict=strict)
    document = JUnitXml.fromstring(text.encode("utf-8"))
    found = list(document)
    assert document.tests == sum(suite.tests for suite in found)
    assert document.failures == sum(suite.failures for suite in found)
    return found


def cases(judgement: Judgement, *, strict: bool = False) -> dict[str, TestCase]:
    (suite,) = suites(judgement, strict=strict)
    found = list(suite)
    results = [each for case in found for each in case.result]
    assert suite.tests == len(found)
    assert suite.failures == sum(isinstance(each, Failure) for each in results)
    assert suite.skipped == sum(isinstance(each, Skipped) for each in results)
    assert suite.errors == sum(isinstance(each, Error) for each in results)
    return {case.name: case for case in found}


def outcomes(judgement: Judgement, *, strict: bool = False) -> dict[str, list[type]]:
    found = cases(judgement, strict=strict)
    return {name: [type(each) for each in case.result] for name, case in found.items()}


def test_every_log_is_a_suite_and_every_rule_a_test() -> None:
    found = suites(PLAIN, GOOD, EMPTY)
    assert [suite.name for suite in found] == ["drive.blf", "good.log", "empty.log"]
    names = [(case.classname, case.name) for case in found[0]]
    assert names[0] == ("swapcan.conform", "judged")
    assert names[1:] == [
        (f"swapcan.conform.{each.rule.severity.name.lower()}", each.rule.id)
        for each in PLAIN.results
    ]


def test_only_broken_demands_fail_unless_it_is_strict() -> None:
    plain = {
        "judged": [Error],  # it is damaged
        "answer-in-time": [Failure],
        "period-mean": [],
        "spare-bits": [],
        "checksum": [],
        "never-seen": [Skipped],
    }
    assert outcomes(PLAIN) == plain
    assert outcomes(PLAIN, strict=True) == plain | {"period-mean": [Failure]}


def test_what_could_not_be_judged_is_an_error() -> None:
    assert outcomes(EMPTY)["judged"] == [Error]
    (error,) = cases(EMPTY)["judged"].result
    assert error.type == "not_judged"
    assert outcomes(GOOD)["judged"] == []
    damaged = replace(GOOD, damage=("good.log: damaged at line 3",))
    assert outcomes(damaged)["judged"] == [Error]


def test_a_failure_lists_its_occurrences_and_counts_those_that_are_not_kept() -> None:
    (failure,) = cases(PLAIN)["answer-in-time"].result
    assert isinstance(failure, Failure)
    assert failure.type == "must"
    assert failure.message == (
        "Title of answer-in-time (5.2.1, Table 14 row 3): found: 1,234, frames: 3,702"
    )
    assert (failure.text or "").splitlines() == [
        "2.500 s BMU B2V_ST2_SOC frame 3: step of 0.25 s",
        "5.000 s BMU B2V_ST2_SOC frame 3: step of 0.25 s",
        "and 1,232 more; see the CSV or JSON report",
    ]


def test_what_does_not_fail_is_still_told() -> None:
    root = ET.fromstring(to_junit([PLAIN], "en"))
    told = {each.get("name"): each.get("value") for each in root.iter("property")}
    assert told["verdict"] == "violates"
    assert told["should.period-mean"] == told["info.spare-bits"] == "1"
    output = cases(PLAIN)["period-mean"].system_out
    assert output is not None
    assert "1.000 s BMU B2V_ST2_SOC frame 3: step of 0.25 s" in output


def test_elements_stand_in_the_order_that_the_schema_of_jenkins_asks_for() -> None:
    root = ET.fromstring(to_junit([PLAIN], "en"))
    (suite,) = root
    tags = [child.tag for child in suite]
    assert tags == ["properties", *["testcase"] * (1 + len(PLAIN.results))]
    allowed = {"skipped", "error", "failure", "system-out"}
    assert all({child.tag for child in case} <= allowed for case in suite.iter("testcase"))
    assert {"name", "tests", "failures", "errors", "skipped", "time"} == set(suite.attrib)


@pytest.mark.parametrize("text", HOSTILE)
def test_any_text_arrives_with_what_can_be_seen_of_it(text: str) -> None:
    (suite,) = suites(hostile(text))
    _, case = suite
    (failure,) = case.result
    shown = failure.text or ""
    assert len(shown.splitlines()) == 1
    assert all(each in shown for each in text if each.isprintable())
    if text.isprintable():
        assert suite.name == text


def test_it_speaks_chinese() -> None:
    text = to_junit([PLAIN], "zh")
    assert "间隔 0.25 s" in text
    assert "发现 1,234 次" in text
    assert "step of" not in text
