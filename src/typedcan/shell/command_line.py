"""The frame of a command line: its commands, imported when chosen, and its exit statuses."""

from __future__ import annotations

import argparse
import io
import logging
import sys
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NoReturn

from typedcan.model.errors import ReadError, one_line
from typedcan.shell.console import (
    CommandError,
    OutputClosedError,
    finish,
    name_program,
    note,
    say,
    say_text,
)

_LOG = logging.getLogger("typedcan")

# What shtab calls a file, for the completion of shells.
_FILE = {"bash": "_shtab_compgen_files", "zsh": "_files", "tcsh": "f"}

_SIGNALS = 128
"""What the exit status of a command that a signal has ended is above of."""

Subcommands = argparse._SubParsersAction  # noqa: SLF001 - argparse has no public name for it


@dataclass(frozen=True, slots=True)
class Command:
    """A command: ``help`` in one line, its examples, its arguments and what it does.

    ``run`` returns the exit status.
    """

    name: str
    help: str
    examples: str
    add_arguments: Callable[[argparse.ArgumentParser], None]
    run: Callable[[argparse.Namespace], int]

    def add(self, commands: Subcommands[Parser]) -> None:
        """Add the command to those of a parser."""
        part = commands.add_parser(
            self.name,
            help=self.help,
            description=f"{self.help[0].upper()}{self.help[1:]}.",
            epilog=f"examples:\n{self.examples}",
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        part.set_defaults(run=self.run)
        self.add_arguments(part)


@dataclass(frozen=True, slots=True)
class Program:
    """A command line.

    Parameters
    ----------
    name, description, epilog
        Of its help.
    commands
        What each command does, in a line, in the order of the help.
    add
        Imports a command, and adds it, with others of its file if need be.
    """

    name: str
    description: str
    epilog: str
    commands: Mapping[str, str]
    add: Callable[[Subcommands[Parser], str], None]
    add_options: Callable[[argparse.ArgumentParser], None] = field(default=lambda _: None)

    def parser(self, chosen: Collection[str] | None = None) -> Parser:
        """The parser of all commands, complete for those that are chosen: only they are imported.

        Some take longer to import than to run.
        """
        parser = Parser(
            prog=self.name,
            description=self.description,
            epilog=self.epilog,
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
        self.add_options(parser)
        parser.set_defaults(run=lambda options: self._no_command(parser, options.print_completion))
        commands = parser.add_subparsers(title="commands", metavar="COMMAND")
        for name in self.commands:
            if (chosen is None or name in chosen) and name not in commands.choices:
                self.add(commands, name)
        for name, text in self.commands.items():
            if name not in commands.choices:
                commands.add_parser(name, help=text)
        return parser

    def _no_command(self, parser: argparse.ArgumentParser, shell: str | None) -> int:
        """Print a completion script, or help where none is asked for either."""
        if shell is None:
            parser.print_help(sys.stderr)
            return 2
        try:
            import shtab
        except ModuleNotFoundError:
            message = "completion needs shtab: pip install 'swapcan[completion]'"
            raise CommandError(message) from None
        say_text(shtab.complete(self.parser(), shell))
        return 0


class Parser(argparse.ArgumentParser):
    """Reports a wrong argument in one line."""

    def error(self, message: str) -> NoReturn:
        """Raise the message as `CommandError`."""
        raise CommandError(f"{message}; see {self.prog} --help")

    def print_help(self, file: object = None) -> None:
        """Print help as results are: argparse says nothing where it cannot be written."""
        if file is None:
            say_text(self.format_help())
        else:
            super().print_help(sys.stderr)


def completing_files(*arguments: argparse.Action) -> None:
    """Let the shell complete these by the names of files."""
    for each in arguments:
        vars(each)["complete"] = _FILE


class _Version(argparse.Action):
    """Prints the version, which takes a while to find out."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from importlib.metadata import PackageNotFoundError, version

        try:
            found = version("swapcan")
        except PackageNotFoundError:
            found = "(not installed)"
        say(f"{parser.prog} {found}")
        parser.exit()


def run(
    program: Program,
    arguments: Sequence[str],
    failed: Callable[[Exception], int | None] = lambda _: None,
) -> int:
    """Run a command line with its arguments and return the exit status.

    Whatever stops a command is one line on stderr, and 2; ``failed`` is asked first, and may say
    it in its own way, and another status.
    """
    name_program(program.name.split()[-1])
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a narrow code page shows ? instead
    # What is wrong with a bus is raised; python-can's log would say it a second time.
    logging.getLogger("can").addHandler(logging.NullHandler())
    try:
        status = _dispatch(program, arguments)
        finish()
    except OutputClosedError:
        note("nobody reads the output any more")
        return 2
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # noqa: BLE001 - what drivers and files bring about is no list
        told = failed(error) if isinstance(error, Exception) else None
        if told is not None:
            return told
        ours = isinstance(error, ReadError | CommandError)  # one line, which may cite a name
        note(str(error) if ours else one_line(error))
        _LOG.debug("what stopped the command", exc_info=True)
        return 2
    return status


def _dispatch(program: Program, arguments: Sequence[str]) -> int:
    try:
        options = program.parser(arguments).parse_args(arguments)
    except SystemExit:  # help or version was printed
        return 0
    command: Callable[[argparse.Namespace], int] = options.run
    try:
        return command(options)
    except KeyboardInterrupt:
        return 130
    except SystemExit as leaving:
        if isinstance(leaving.code, int) and leaving.code > _SIGNALS:
            return leaving.code
        raise  # a driver's idea, not ours: the command has not done its work
