"""Counts the lines of a text log that should be frames and are none."""

from __future__ import annotations

from pathlib import Path

from typedcan.logs.read.lines import LineBatch
from typedcan.logs.read.source import Damage

_EXCERPT = 40


class BadLines:
    """The bad lines of one log.

    Parameters
    ----------
    form
        The format, for messages: "a candump log".
    """

    def __init__(self, form: str) -> None:
        self._form = form
        self._count = 0
        self._where = ""
        self._problem = ""

    def add(self, batch: LineBatch, row: int) -> None:
        """Count a line; only the first one is remembered."""
        self._count += 1
        if self._count == 1:
            excerpt = batch.line(row)[:_EXCERPT].decode(errors="backslashreplace")
            self._where = f"line {batch.number + row}"
            self._problem = f"no line of {self._form}: {excerpt!r}"

    def damage(self, path: Path, end: str | None, lines: int) -> Damage | None:
        """What is wrong with a log of so many lines; ``end`` is what ended it too early, if so."""
        lost = "1 line" if self._count == 1 else f"{self._count:,} lines"
        if end is None:
            return Damage(path, self._where, self._problem, lost) if self._count else None
        rest = f"what follows line {lines}"
        if self._count:
            return Damage(path, self._where, self._problem, f"{lost} and {rest}")
        return Damage(path, f"line {lines + 1}", end, rest)
