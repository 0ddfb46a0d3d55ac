"""Judgements as JUnit XML: a suite per log, a test per rule, and one for whether it was judged."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Sequence

from typedcan.judge.findings import Occurrence
from typedcan.judge.judgement import Judgement, RuleResult, Status, Verdict
from typedcan.judge.report import facts, figures, words
from typedcan.judge.rule import Severity
from typedcan.report.language import Language
from typedcan.shell.printing import printable

_SHOWN = 100
"""Occurrences of a rule that are listed."""


def to_junit(judgements: Sequence[Judgement], language: Language, *, strict: bool = False) -> str:
    """The XML text.

    A rule that judged nothing is skipped; where the log could not be judged, or not all of it, the
    first test is an error. What is found for other rules than demands stands in
    the output of their tests, and their number in the properties of the suite.

    Parameters
    ----------
    strict
        Whether a recommendation that is not heeded fails its test too.
    """
    gravest = Severity.SHOULD if strict else Severity.MUST
    suites = [_suite(judgement, language, gravest) for judgement in judgements]
    root = ET.Element("testsuites")
    for name in ("tests", "failures", "errors"):
        root.set(name, str(sum(int(suite.get(name, "0")) for suite in suites)))
    root.set("time", "0")
    root.extend(suites)
    ET.indent(root)
    body = ET.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{body}\n'


def _suite(judgement: Judgement, language: Language, failing: Severity) -> ET.Element:
    suite = ET.Element("testsuite", {"name": printable(judgement.log)})
    properties = ET.SubElement(suite, "properties")
    for name, value in _properties(judgement, language):
        ET.SubElement(properties, "property", {"name": name, "value": printable(value)})
    cases = [_judged(judgement, language)]
    cases += [_case(judgement, result, language, failing) for result in judgement.results]
    suite.extend(cases)
    counts = {
        "tests": len(cases),
        "failures": sum(case.find("failure") is not None for case in cases),
        "errors": sum(case.find("error") is not None for case in cases),
        "skipped": sum(case.find("skipped") is not None for case in cases),
    }
    for name, number in counts.items():
        suite.set(name, str(number))
    suite.set("time", "0")
    return suite


def _properties(judgement: Judgement, language: Language) -> list[tuple[str, str]]:
    found = [
        ("verdict", judgement.verdict.name.lower()),
        ("reason", facts.why(judgement, language)),
        ("sha256", judgement.digest),
        ("protocol", f"{judgement.protocol.name} {judgement.protocol.digest}"),
        ("nodes", ", ".join(judgement.nodes)),
        ("seen", ", ".join(judgement.seen)),
    ]
    found += [("damage", line) for line in judgement.damage]
    for severity in (Severity.SHOULD, Severity.INFO):
        for result in facts.failed(judgement, severity):
            found.append((f"{severity.name.lower()}.{result.rule.id}", str(result.count)))
    return found


def _judged(judgement: Judgement, language: Language) -> ET.Element:
    case = ET.Element("testcase", {"classname": "swapcan.conform", "name": "judged", "time": "0"})
    problems = list(judgement.damage)
    if judgement.verdict is Verdict.NOT_JUDGED:
        problems.append(facts.why(judgement, language))
    if problems:
        message = printable("; ".join(problems))
        ET.SubElement(case, "error", {"message": message, "type": "not_judged"})
    return case


def _case(
    judgement: Judgement, result: RuleResult, language: Language, failing: Severity
) -> ET.Element:
    # Class and name say which test it is from one run to the next: nothing else is in them.
    severity = result.severity
    classname = f"swapcan.conform.{result.rule.severity.name.lower()}"
    case = ET.Element("testcase", {"classname": classname, "name": result.rule.id, "time": "0"})
    message = facts.cited(result.rule.title.within(language), result.rule, language)
    if result.status is Status.NOT_JUDGED:
        ET.SubElement(case, "skipped", {"message": facts.reason(judgement, result, language)})
    elif result.count and severity >= failing:
        heading = f"{message}{words.COLON.within(language)}{facts.found(result, language)}"
        attributes = {"message": printable(heading), "type": severity.name.lower()}
        ET.SubElement(case, "failure", attributes).text = _lines(result, language)
    elif result.count:
        ET.SubElement(case, "system-out").text = f"{printable(message)}\n{_lines(result, language)}"
    return case


def _lines(result: RuleResult, language: Language) -> str:
    lines = [_line(found, language) for found in result.occurrences[:_SHOWN]]
    if result.count > len(lines):
        more = figures.count(result.count - len(lines))
        lines.append(words.MORE.within(language).format(count=more))
    return "\n".join(lines)


def _line(found: Occurrence, language: Language) -> str:
    subject = printable(f"{found.subject.node} {found.subject}".rstrip())
    colon = words.COLON.within(language)
    return f"{figures.seconds(found.start)} {subject}{colon}{facts.says(found, language)}"
