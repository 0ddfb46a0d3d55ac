"""Does what is on a bus keep to its protocol? Needs the extra ``logs``.

For example, with a protocol that `typedcan.dynamic.typed_protocol` made, or a generated one:

    judgement = judge_log(Judge(protocol), "drive.blf")
    print(judgement.verdict)
    for result in judgement.of_status(Status.FAILED):
        print(result.rule.id, result.count, result.first)
"""

from typedcan.judge.findings import LeftOpen, Occurrence, Subject
from typedcan.judge.judge import Judge, JudgeError
from typedcan.judge.judgement import Judgement, RuleResult, Status, Verdict
from typedcan.judge.logs import judge_log
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.rules import rules_for
from typedcan.judge.scope import Scope
from typedcan.judge.tolerance import Tolerance

__all__ = [
    "Judge",
    "JudgeError",
    "Judgement",
    "LeftOpen",
    "Occurrence",
    "Rule",
    "RuleResult",
    "Scope",
    "Severity",
    "Status",
    "Subject",
    "Tolerance",
    "Verdict",
    "judge_log",
    "rules_for",
]
