"""What all commands share: results, remarks, the error of the user's, numbers as arguments."""

from __future__ import annotations

import argparse
import errno
import math
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from typedcan.model.errors import TypedcanError
from typedcan.shell.printing import print_line, print_remark, print_text, printable


class CommandError(TypedcanError):
    """Something that the user of the command line can mend."""


class OutputClosedError(BrokenPipeError):
    """Nobody reads the results any more; apart from a bus whose other end is gone."""


_program = ["typedcan"]


def name_program(name: str) -> None:
    """Say what remarks of this process begin with: the name of its command line."""
    _program[0] = name


def say(text: str, *, flush: bool = False) -> None:
    """Print a line of the results.

    Raises `OutputClosedError` where nobody reads any more, and `CommandError` where the output
    cannot be written.
    """
    with _writing():
        print_line(text, flush=flush)


def say_text(text: str, *, coloured: bool = False) -> None:
    """Print results of several lines, as `typedcan.shell.printing.print_text`; raises as `say`."""
    with _writing():
        print_text(text, coloured=coloured)


def finish() -> None:
    """Write what `say` has printed and is still on its way; raises as `say`."""
    with _writing():
        if sys.stdout:
            sys.stdout.flush()


@contextmanager
def _writing() -> Iterator[None]:
    try:
        yield
    except OSError as error:
        # Keep the interpreter from writing the rest when it ends.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if error.errno in (errno.EPIPE, errno.EINVAL):  # EINVAL is what Windows says
            raise OutputClosedError from None
        raise CommandError(f"cannot write the output: {error.strerror}") from None


def note(text: str) -> None:
    """Print a remark or an error, beside the results; where nobody reads it that is no trouble."""
    print_remark(f"{_program[0]}: {text}")


def warn(text: str) -> None:
    """Print a remark from any thread, also where another hangs in printing one."""
    with suppress(Exception):
        os.write(sys.stderr.fileno(), f"{_program[0]}: {printable(text)}\n".encode())


def seconds(text: str) -> float:
    """A positive number of seconds, as the type of an argument."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"expected a positive number of seconds, not {text!r}")
    return value


def count(text: str) -> int:
    """A positive whole number, as the type of an argument."""
    if not (text.isdecimal() and int(text)):
        raise argparse.ArgumentTypeError(f"expected a positive whole number, not {text!r}")
    return int(text)
