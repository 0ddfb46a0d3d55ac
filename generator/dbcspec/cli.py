"""The `dbcspec` command line: what the commands are, and how errors become exit statuses."""

from __future__ import annotations

import argparse
import io
import os
import sys
from collections.abc import Callable, Collection, Sequence
from importlib import import_module
from typing import NoReturn

from dbcspec.commands import HELP, MODULES
from dbcspec.errors import FindingsError, SpecError, StaleArtifactError
from typedcan.model.errors import ReadError
from typedcan.shell.printing import print_remark, print_text

_EXAMPLES = """examples:
  dbcspec generate                       write the DBC files, stubs and schemas of the spec
  dbcspec check                          in CI: exit 1 where a generated file is not current
  dbcspec lint supplier.dbc              faults in a file, whoever wrote it
  dbcspec compare spec dbc/vehicle.dbc   does the DBC say what the spec says
  dbcspec compare HEAD~3:spec spec --fail-on wire --format markdown
  dbcspec matrix export                  the Excel CAN matrix
  dbcspec load --groups 18               bus load and worst-case response times
  dbcspec show ECU1_Status               one message: bits, signals, codes, errata

exit status: 0 all is well, 1 findings or stale files, 2 the command could not do its work"""


def run(arguments: Sequence[str]) -> int:
    """Run the command line with its arguments and return the exit status."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a code page without Chinese shows ? instead
    try:
        options = command_line(arguments[:1]).parse_args(arguments)
        command: Callable[[argparse.Namespace], int] = options.run
        return command(options)
    except (FindingsError, StaleArtifactError, SpecError) as error:
        for line in error.lines:
            print_remark(line)
        return 2 if isinstance(error, SpecError) else 1
    except ReadError as error:
        print_remark(f"dbcspec: {error}")
        return 2
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        # The reader went away: leave quietly, and keep the interpreter from flushing into it.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1


class _Parser(argparse.ArgumentParser):
    """Reports a wrong argument in one line."""

    def error(self, message: str) -> NoReturn:
        raise ReadError(f"{message}; see {self.prog} --help")


class _Version(argparse.Action):
    """Prints the version, which takes a while to find out."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from importlib.metadata import version

        print_text(f"dbcspec {version('swapcan')}\n")
        parser.exit()


def command_line(chosen: Collection[str] = tuple(HELP)) -> argparse.ArgumentParser:
    """The parser of all commands, complete for those that are chosen.

    What only those need is imported: some commands take longer to import than to run.
    """
    parser = _Parser(
        prog="dbcspec",
        description="A CAN protocol as data: tables in YAML in, DBC files and Python stubs out.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "--version", action=_Version, nargs=0, help="show program's version number and exit"
    )
    parser.add_argument(
        "--print-completion",
        choices=("bash", "zsh", "tcsh"),
        help="print a completion script for a shell",
    )
    parser.set_defaults(run=lambda options: _no_command(parser, options.print_completion))
    commands = parser.add_subparsers(title="commands", metavar="COMMAND")
    for name in dict.fromkeys(MODULES[command] for command in HELP if command in chosen):
        import_module(f"dbcspec.commands.{name}").add(commands)
    for command, text in HELP.items():
        if command not in commands.choices:
            commands.add_parser(command, help=text)
    return parser


def _no_command(parser: argparse.ArgumentParser, shell: str | None) -> int:
    """Print a completion script, or help where none is asked for either."""
    if shell is None:
        parser.print_help(sys.stderr)
        return 2
    try:
        import shtab
    except ModuleNotFoundError:
        raise ReadError("completion needs shtab: pip install 'swapcan[completion]'") from None
    print_text(shtab.complete(command_line(), shell))
    return 0
