"""Logs judged by one rule, so many frames at a time."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from swapcan.conform import Judge, Rule, RuleResult
from swapcan.logs.read import open_log

ALL = 1 << 16


NODES = ("BMU", "VCU", "CHG", "TMS", "BSU")


def result_of(
    rule: Rule, log: Path, size: int = ALL, *, nodes: Iterable[str] = NODES
) -> RuleResult:
    """What a rule finds in a log that is read in blocks of ``size`` frames."""
    judge = Judge(nodes, rules=[rule])
    with open_log(log, size) as source:
        for block in source:
            judge.take(block)
        assert source.damage is None
    return judge.finish().result(rule.id)


def candump(path: Path, *lines: str) -> Path:
    """A candump log of lines such as ``0.1 can0 123#00``."""
    rows = [line.split() for line in lines]
    text = "".join(f"({float(time):.6f}) {channel} {frame}\n" for time, channel, frame in rows)
    path.write_text(text, "ascii", newline="\n")
    return path


def found(result: RuleResult) -> list[tuple[str, float, float, int, str]]:
    """The occurrences: about what, from when to when, how many frames, and what is said."""
    return [
        (str(each.subject), round(each.start, 6), round(each.end, 6), each.frames, each.says())
        for each in result.occurrences
    ]
