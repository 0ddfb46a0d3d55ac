"""Conformance: does what is on a bus speak the standard? Needs the extra ``logs``.

For example:

    judgement = judge_log("drive.blf", nodes=["BMU"])
    print(judgement.verdict)
    for result in judgement.of_status(Status.FAILED):
        print(result.rule.id, result.count, result.first)
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path

from swapcan._generated.protocol import PROTOCOL
from swapcan.rules import RULES, rule_of
from typedcan.judge import judge, logs
from typedcan.judge.findings import Occurrence, Subject
from typedcan.judge.judge import JudgeError as ConformError
from typedcan.judge.judgement import Judgement, RuleResult, Status, Verdict
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.logs.checksums import NONE
from typedcan.logs.part import ALL, Window
from typedcan.model.checksums.registry import Given

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
    "rule_of",
]


class Judge(judge.Judge):
    """Takes the frames of one log in their order; see `typedcan.judge.judge.Judge`.

    Parameters
    ----------
    nodes
        Whom to judge.
    rules
        By what.
    limits
        Tolerances by name that are to have another value.
    algorithms
        What computes the checksums that the standard leaves open, as `swapcan.Codec` has it.

    Raises
    ------
    ConformError
        There is no such node or tolerance.
    AlgorithmError
        There is no algorithm of a name that is given, or what is given is none.
    """

    def __init__(
        self,
        nodes: Iterable[str] = PROTOCOL.nodes,
        rules: Sequence[Rule] = RULES,
        limits: Mapping[str, float] | None = None,
        *,
        algorithms: Given = NONE,
    ) -> None:
        super().__init__(
            PROTOCOL, rules, nodes=nodes, limits=limits, known=RULES, algorithms=algorithms
        )


def judge_log(
    log: Path | str,
    nodes: Iterable[str] = PROTOCOL.nodes,
    *,
    rules: Sequence[Rule] = RULES,
    limits: Mapping[str, float] | None = None,
    window: Window = ALL,
    watch: Callable[[int, int], None] | None = None,
    algorithms: Given = NONE,
) -> Judgement:
    """Judge a log of any kind; see `typedcan.judge.logs.judge_log`, and `Judge`."""
    by = Judge(nodes, rules, limits, algorithms=algorithms)
    return logs.judge_log(by, log, window=window, watch=watch)
