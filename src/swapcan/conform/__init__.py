"""Conformance: does what is on a bus speak the standard? Needs the extra ``logs``.

For example:

    judgement = judge_log("drive.blf", nodes=["BMU"])
    print(judgement.verdict)
    for result in judgement.of_status(Status.FAILED):
        print(result.rule.id, result.count, result.first)
"""

from swapcan.conform.findings import Occurrence, Subject
from swapcan.conform.judge import ConformError, Judge
from swapcan.conform.judgement import Judgement, RuleResult, Status, Verdict
from swapcan.conform.logs import judge_log
from swapcan.conform.registry import RULES
from swapcan.conform.rule import Rule, Severity
from swapcan.conform.tolerance import Tolerance

__all__ = [
    "RULES",
    "ConformError",
    "Judge",
    "Judgement",
    "Occurrence",
    "Rule",
    "RuleResult",
    "Severity",
    "Status",
    "Subject",
    "Tolerance",
    "Verdict",
    "judge_log",
]
