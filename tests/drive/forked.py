"""Commands as processes of their own, forked from one that has loaded all that they need.

Run as a program it reads their arguments from its standard input, as JSON, and tells their numbers
and, in the end, how each ended. Their look-out is short.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from commands.running import started


@dataclass
class Forked:
    """A process: its number, what it has said on stderr, how it ended."""

    pid: int
    path: Path
    status: int | None = None

    @property
    def errors(self) -> str:
        """What it has said so far."""
        return self.path.read_text("utf-8")


class Parent:
    """The process that forks."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self._process = process
        self.children: list[Forked] = []

    def fork(self, folder: Path, commands: Sequence[Sequence[str]]) -> list[Forked]:
        """Start commands, in this order."""
        assert self._process.stdin
        paths = [folder / f"stderr-{number}" for number in range(len(commands))]
        given = [[str(path), *command] for path, command in zip(paths, commands, strict=True)]
        self._process.stdin.write(json.dumps(given) + "\n")
        self._process.stdin.flush()
        self.children = list(map(Forked, self._numbers(), paths))
        return self.children

    def wait(self) -> None:
        """Wait until all have ended; their ``status`` is the exit status, -N where N ended it."""
        for child, status in zip(self.children, self._numbers(), strict=True):
            child.status = status

    def _numbers(self) -> list[int]:
        assert self._process.stdout
        numbers: list[int] = json.loads(self._process.stdout.readline())
        return numbers


@contextmanager
def parent() -> Iterator[Parent]:
    """A process that forks; what it has forked does not outlive the block."""
    with started("-m", "drive.forked") as process:
        forking = Parent(process)
        try:
            yield forking
        finally:
            for child in forking.children:
                if child.status is None:
                    os.kill(child.pid, 9)


def _main() -> None:
    import swapcan.commands.conform_driving  # noqa: F401 - is loaded once for all
    from typedcan.drive import driving

    driving.LOOK_OUT = 0.3
    pids = [_fork(*given) for given in json.loads(sys.stdin.readline())]
    print(json.dumps(pids), flush=True)
    print(json.dumps([_status_of(pid) for pid in pids]), flush=True)


def _fork(errors: str, *arguments: str) -> int:
    from swapcan.__main__ import main

    if pid := os.fork():
        return pid
    sys.argv = ["swapcan", *arguments]
    with open(errors, "wb") as file, open(os.devnull, "wb") as nowhere:  # noqa: PTH123
        os.dup2(nowhere.fileno(), 1)
        os.dup2(file.fileno(), 2)
        status = main()
        os._exit(status)


def _status_of(pid: int) -> int:
    return os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])


if __name__ == "__main__":
    _main()
