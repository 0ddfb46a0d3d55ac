"""Where judgements go: a summary on stdout, and files that appear complete or not at all."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Self

from typedcan.judge import Judgement
from typedcan.judge.report import environment, moments, summary, to_csv, to_html, to_json, to_junit
from typedcan.report.language import Language
from typedcan.shell.console import CommandError, note, say_text
from typedcan.shell.files import put_in_place


@dataclass(frozen=True, slots=True)
class Judged:
    """What came of one log.

    Parameters
    ----------
    judgement, path
        The judgement, and the file with the frames.
    expected
        The ids of rules that had to judge something.
    cut
        Why there is less than there was to be, if so.
    """

    judgement: Judgement
    path: Path
    expected: tuple[str, ...] = ()
    cut: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Reports:
    """What is wanted of them.

    Parameters
    ----------
    files
        By kind: html, junit, csv.
    json, verbose
        What stdout is to have.
    language
        Of all of them.
    strict
        Whether a recommendation counts like a demand.
    """

    files: dict[str, Path]
    json: bool
    verbose: bool
    language: Language
    strict: bool

    @classmethod
    def of(cls, given: argparse.Namespace) -> Self:
        """Read the options."""
        files = {kind: getattr(given, kind) for kind in ("html", "junit", "csv")}
        return cls(
            files={kind: path for kind, path in files.items() if path},
            json=given.json,
            verbose=given.verbose,
            language=given.language,
            strict=given.strict,
        )

    def check(self, logs: Iterable[Path]) -> None:
        """See that no file would take the place of a log, a folder or another report.

        Raises `CommandError`: before hours of a log are judged.
        """
        taken = {log.resolve(): f"{log} is the log" for log in logs}
        for kind, path in self.files.items():
            if path.is_dir():
                raise CommandError(f"{path}: there is a folder of that name")
            place = path.resolve()
            if place in taken:
                raise CommandError(f"--{kind}: {taken[place]}")
            taken[place] = f"{path} is written already"

    def write(self, judged: Sequence[Judged], status: int) -> None:
        """Print the summary, and write what is wanted; raises `CommandError`.

        ``status`` is the exit status of the command.
        """
        judgements = [each.judgement for each in judged]
        if self.json:
            say_text(to_json(judgements, self.language))
        else:
            colour = _has_colours()
            lines = summary(
                judgements, self.language, colour=colour, verbose=self.verbose, status=status
            )
            say_text("\n".join(lines), coloured=colour)
        for kind, path in self.files.items():
            _put(path, self._text(kind, judged))
            note(f"wrote {path}")

    def _text(self, kind: str, judged: Sequence[Judged]) -> str:
        judgements = [each.judgement for each in judged]
        if kind == "csv":
            return to_csv(judgements, self.language)
        if kind == "junit":
            return to_junit(judgements, self.language, strict=self.strict)
        found = [moments(each.path, each.judgement) for each in judged]
        return to_html(judgements, found, self.language, environment())


def _put(path: Path, text: str) -> None:
    """Write a file, in a folder that is made for it."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise CommandError(f"{path}: cannot be written: {error.strerror or error}") from None
    put_in_place({path: text.encode("utf-8")})


def _has_colours() -> bool:
    if not sys.stdout or not sys.stdout.isatty() or os.environ.get("TERM") == "dumb":
        return False
    # An old console of Windows would show the escape sequences.
    knows = sys.platform != "win32" or "WT_SESSION" in os.environ
    return knows and not os.environ.get("NO_COLOR")
