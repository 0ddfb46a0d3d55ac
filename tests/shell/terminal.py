"""A command in a terminal of its own."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

# Makes the pseudo-terminal the one whose Ctrl-C interrupts the process.
_PROGRAM = """
import fcntl, runpy, sys, termios
fcntl.ioctl(0, termios.TIOCSCTTY, 0)
runpy.run_module(sys.argv.pop(1), run_name="__main__", alter_sys=True)
"""


def in_terminal(
    *words: str,
    environment: Mapping[str, str],
    folder: Path | None = None,
    after: str = "",
    typed: bytes = b"",
) -> tuple[str, int]:
    """What a command shows, and its exit status; ``typed`` is typed once ``after`` is shown.

    The first of the words is the package that is run.
    """
    ours, theirs = os.openpty()
    process = subprocess.Popen(
        [sys.executable, "-c", _PROGRAM, *words],
        cwd=folder,
        env=environment,
        stdin=theirs,
        stdout=theirs,
        stderr=theirs,
        start_new_session=True,
    )
    os.close(theirs)
    shown = b""
    while chunk := _read(ours):
        shown += chunk
        if typed and after.encode() in shown:
            os.write(ours, typed)
            typed = b""
    os.close(ours)
    return shown.decode(), process.wait(timeout=10)


def _read(terminal: int) -> bytes:
    """What is shown next; empty once the process has ended, which Linux calls an error."""
    try:
        return os.read(terminal, 65536)
    except OSError:
        return b""
