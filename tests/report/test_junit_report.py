"""JUnit XML as an independent reader of it sees it."""

from __future__ import annotations

import pytest
from junitparser import Failure, JUnitXml, TestCase, TestSuite
from report.samples import EMPTY, HOSTILE, PLAIN, RULES, hostile, item

from typedcan.report.formats import render
from typedcan.report.item import Report


def cases(report: Report) -> list[TestCase]:
    document = JUnitXml.fromstring(render(report, "junit").encode("utf-8"))
    (suite,) = document
    assert isinstance(suite, TestSuite)
    found = list(suite)
    failed = [case for case in found if case.result]
    assert (document.tests, document.failures, document.errors) == (len(found), len(failed), 0)
    assert (suite.tests, suite.failures) == (len(found), len(failed))
    return found


def test_every_rule_is_a_case_that_fails_where_it_has_findings() -> None:
    failing = {item.rule for item in PLAIN.items}
    found = {case.name: bool(case.result) for case in cases(PLAIN)}
    assert found == {rule.id: rule.id in failing for rule in RULES}
    assert not any(case.result for case in cases(EMPTY))


def test_a_failure_lists_each_finding_on_a_line() -> None:
    (first, *_) = cases(PLAIN)
    (failure,) = first.result
    assert isinstance(failure, Failure)
    assert failure.type == "wire"
    assert failure.message == "2 findings against: A raw step keeps its physical value."
    lines = (failure.text or "").splitlines()
    assert len(lines) == 2
    assert lines[0].startswith("spec/tables/01-state.yaml:17:9: Speed: factor 0.4 → 0.5")
    assert lines[0].endswith(f"breaks sender and receiver [{PLAIN.items[0].fingerprint}]")


def test_a_rule_that_nobody_listed_still_fails() -> None:
    report = Report(title="", items=[item(rule="surprise")], rules=())
    (case,) = cases(report)
    assert case.name == "surprise"
    assert case.result


def test_a_case_keeps_its_name_when_its_findings_change() -> None:
    before, after = cases(EMPTY), cases(hostile())
    names = [(case.classname, case.name) for case in before]
    assert names == [(case.classname, case.name) for case in after][: len(names)]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("text", HOSTILE)
def test_any_text_arrives_with_what_can_be_seen_of_it(text: str) -> None:
    made = item(subject=text, old="1", new="2", text="unit")
    (case, *_) = cases(Report(title=text, items=[made], rules=RULES))
    (failure,) = case.result
    seen = "".join(c for c in text if c.isprintable())
    shown = failure.text or ""
    assert len(shown.splitlines()) == 1
    assert all(c in shown for c in seen)
    if text.isprintable() and text:
        assert f"{text}: unit (1 → 2)" in shown
