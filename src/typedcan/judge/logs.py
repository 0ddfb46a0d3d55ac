"""Judges log files."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path

from typedcan.judge.judge import Judge
from typedcan.judge.judgement import Judgement
from typedcan.logs.part import ALL, LogPart, Window

_BLOCK = 1 << 17
"""Frames in a chunk: enough that a message's share of it is worth a call per rule."""


def judge_log(
    judge: Judge,
    log: Path | str,
    *,
    window: Window = ALL,
    watch: Callable[[int, int], None] | None = None,
) -> Judgement:
    """Judge a log of any kind that `typedcan.logs.read.open_log` reads.

    Parameters
    ----------
    judge
        A new one, which says whom to judge and by what.
    window
        The part of the log.
    watch
        Is told, now and then, how many bytes are read, and how many frames.

    Raises
    ------
    LogError
        The log cannot be opened. Damage raises nothing: `Judgement.damage` says so.
    TimeError
        The window does not fit the log.
    """
    path = Path(log)
    frames = 0
    with LogPart(path, _BLOCK, window) as source:
        for block in source:
            judge.feed(block)
            frames += len(block)
            if watch:
                watch(source.position, frames)
        source.check_found()
        damage = () if source.damage is None else (str(source.damage),)
    with path.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    return judge.finish(str(log), digest, damage)
