"""Runs the `dbcspec` command as a user does, and looks at what it leaves on disk."""

from __future__ import annotations

import contextlib
import io
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from dbcspec.cli import run


@dataclass(frozen=True)
class Result:
    """How a command ended and what it said."""

    returncode: object
    stdout: str
    stderr: str


def dbcspec(folder: Path, *arguments: str) -> Result:
    """Run the command in a folder; an exception that it lets through fails the test."""
    stdout, stderr = io.StringIO(), io.StringIO()
    streams = contextlib.redirect_stdout(stdout), contextlib.redirect_stderr(stderr)
    with contextlib.chdir(folder), streams[0], streams[1]:
        try:
            status: object = run(arguments)
        except SystemExit as leaving:
            status = leaving.code
    return Result(status, stdout.getvalue(), stderr.getvalue())


def in_a_process_of_its_own(folder: Path, *arguments: str, encoding: str = "utf-8") -> Result:
    """Run the command as a shell does."""
    result = subprocess.run(
        [sys.executable, "-m", "dbcspec", *arguments],
        cwd=folder,
        capture_output=True,
        check=False,
        encoding=encoding,
        env={**os.environ, "PYTHONIOENCODING": encoding},
    )
    assert "Traceback" not in result.stderr, result.stderr
    return Result(result.returncode, result.stdout, result.stderr)


def refused(folder: Path, *arguments: str) -> list[str]:
    """The lines with which a command says that it could not do its work."""
    before = snapshot(folder)
    result = dbcspec(folder, *arguments)
    assert (result.returncode, result.stdout) == (2, "")
    assert snapshot(folder) == before
    return result.stderr.splitlines()


def snapshot(folder: Path) -> dict[str, bytes]:
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }
