"""Judges log files."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.judge import Judge
from swapcan.conform.judgement import Judgement
from swapcan.conform.registry import RULES
from swapcan.conform.rule import Rule
from typedcan.logs.read import open_log
from typedcan.logs.window import Moment, within

_BLOCK = 1 << 17
"""Frames in a chunk: enough that a message's share of it is worth a call per rule."""


def judge_log(
    log: Path | str,
    nodes: Iterable[str] = PROTOCOL.nodes,
    *,
    rules: Sequence[Rule] = RULES,
    limits: Mapping[str, float] | None = None,
    start: Moment | None = None,
    end: Moment | None = None,
    watch: Callable[[int, int], None] | None = None,
) -> Judgement:
    """Judge a log of any kind that `typedcan.logs.read.open_log` reads.

    Parameters
    ----------
    nodes
        Whom to judge.
    rules
        By what.
    limits
        Tolerances by name that are to have another value.
    start, end
        The part of the log.
    watch
        Is told, now and then, how many bytes are read, and how many frames.

    Raises
    ------
    LogError
        The log cannot be opened. Damage raises nothing: `Judgement.damage` says so.
    ConformError
        There is no such node or tolerance.
    TimeError
        ``start`` or ``end`` do not fit the log.
    """
    path = Path(log)
    judge = Judge(nodes, rules, limits)
    frames = 0
    with open_log(path, _BLOCK) as source:
        for block in within(source, start, end):
            judge.take(block)
            frames += len(block)
            if watch:
                watch(source.position, frames)
        damage = () if source.damage is None else (str(source.damage),)
    with path.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    return judge.finish(str(log), digest, damage)
