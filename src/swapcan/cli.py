"""The `swapcan` command line: its commands, and how errors become exit statuses."""

from __future__ import annotations

import argparse
import io
import logging
import sys
from collections.abc import Callable, Collection, Sequence
from importlib import import_module

from swapcan.commands import HELP
from swapcan.console import (
    Command,
    CommandError,
    OutputClosedError,
    Parser,
    finish,
    note,
    say,
    say_text,
)
from typedcan.wire.errors import one_line

_LOG = logging.getLogger("swapcan")

_SIGNALS = 128
"""What the exit status of a command that a signal has ended is above of."""

_EXAMPLES = """examples:
  swapcan demo                                        a pack and a truck on a virtual bus
  swapcan decode drive.blf                            the messages in a log
  swapcan convert drive.blf -o drive.parquet          hours of a log as columns
  swapcan plot drive.blf --signals SOC -o soc.html    signals and cells over time
  swapcan conform drive.blf                           does it keep to the standard?
  swapcan listen -i socketcan -c can0                 the messages on a bus
  swapcan monitor -i socketcan -c can0                the same, as a view
  swapcan send B2V_ST2 soc=80 -i socketcan -c can0    one message onto a bus
  swapcan simulate BMU CHG -i socketcan -c can0       a pack and a charger that behave

exit status: 0 all is well, 1 the demo missed something or a log does not conform, 2 the command
could not do its work, 3 a log is damaged: what could be read was used"""


def run(arguments: Sequence[str]) -> int:
    """Run the command line with its arguments and return the exit status."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a narrow code page shows ? instead
    # What is wrong with a bus is raised; python-can's log would say it a second time.
    logging.getLogger("can").addHandler(logging.NullHandler())
    try:
        status = _dispatch(arguments)
        finish()
    except OutputClosedError:  # the reader went away: leave quietly
        return 1
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # noqa: BLE001 - what drivers and files bring about is no list
        note(one_line(error))
        _LOG.debug("what stopped the command", exc_info=True)
        return 2
    return status


def _dispatch(arguments: Sequence[str]) -> int:
    try:
        options = _parser(arguments[:1]).parse_args(arguments)
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


class _Version(argparse.Action):
    """Prints the version, which takes a while to find out."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from importlib.metadata import PackageNotFoundError, version

        try:
            found = version("swapcan")
        except PackageNotFoundError:
            found = "(not installed)"
        say(f"swapcan {found}")
        parser.exit()


def _parser(chosen: Collection[str] = tuple(HELP)) -> Parser:
    """The parser of all commands, complete for those that are chosen: only they are imported."""
    parser = Parser(
        prog="swapcan",
        description="The CAN protocol of battery-swap heavy trucks: watch it, decode it, send it.",
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
    for name, text in HELP.items():
        if name in chosen:
            _add(commands, import_module(f"swapcan.commands.{name}").COMMAND)
        else:
            commands.add_parser(name, help=text)
    return parser


def _add(commands: argparse._SubParsersAction[Parser], command: Command) -> None:
    part = commands.add_parser(
        command.name,
        help=command.help,
        description=f"{command.help[0].upper()}{command.help[1:]}.",
        epilog=f"examples:\n{command.examples}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    part.set_defaults(run=command.run)
    command.add_arguments(part)


def _no_command(parser: argparse.ArgumentParser, shell: str | None) -> int:
    """Print a completion script, or help where none is asked for either."""
    if shell is None:
        parser.print_help(sys.stderr)
        return 2
    try:
        import shtab
    except ModuleNotFoundError:
        raise CommandError("completion needs shtab: pip install 'swapcan[completion]'") from None
    say_text(shtab.complete(_parser(), shell))
    return 0
