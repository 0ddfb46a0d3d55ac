"""Logs judged so many frames at a time."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import can
from rules.recorded import block_of

from swapcan.conform import Judge, Judgement, Rule, RuleResult
from typedcan.logs.read import open_log

ALL = 1 << 17

NODES = ("BMU", "VCU", "CHG", "TMS", "BSU")


def judged(
    log: Path,
    rules: Sequence[Rule],
    size: int = ALL,
    limits: Mapping[str, float] | None = None,
    *,
    nodes: Iterable[str] = NODES,
) -> Judgement:
    """What rules find in a log that is read in blocks of ``size`` frames."""
    judge = Judge(nodes, rules, limits)
    with open_log(log, size) as source:
        for block in source:
            judge.feed(block)
        assert source.damage is None
    return judge.finish()


def result_of(
    rule: Rule, log: Path, size: int = ALL, *, nodes: Iterable[str] = NODES
) -> RuleResult:
    """The same of one rule."""
    return judged(log, [rule], size, nodes=nodes).result(rule.id)


def judged_by_all(frames: Iterable[can.Message]) -> Judgement:
    """What all rules say of frames."""
    judge = Judge()
    judge.feed(block_of(frames))
    return judge.finish()


def broken(judgement: Judgement) -> set[str]:
    """The rules that found something."""
    return {result.rule.id for result in judgement.results if result.count}


def essence(result: RuleResult) -> tuple[object, ...]:
    """All that was found, to compare."""
    return result.examined, result.count, result.frames, result.occurrences


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
