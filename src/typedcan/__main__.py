"""`python -m typedcan`: the commands for any protocol, which a package or a database describes."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path

from typedcan.shell import command_line
from typedcan.shell.command_line import Parser, Program, Subcommands, completing_files
from typedcan.shell.printing import print_warnings

_HELP = {
    "decode": "print the messages in a log file",
    "convert": "write log files as tables: Parquet, Arrow, CSV or MF4",
    "plot": "draw signals of a log file over time",
    "conform": "judge whether logs, or what a bus carries, keep to the protocol",
    "send": "send one message; what is not given goes out as invalid, or 0 if that is idle",
    "listen": "print the messages on a bus as they arrive, until Ctrl-C",
    "monitor": "watch a bus in the terminal: messages with their periods, and signals",
}

_EXAMPLES = """examples:
  python -m typedcan --dbc truck.dbc decode drive.blf
  python -m typedcan --dbc truck.dbc convert drive.blf -o drive.parquet
  python -m typedcan --protocol acme.can listen -i socketcan -c can0
  python -m typedcan --dbc truck.dbc conform drive.blf
  python -m typedcan --dbc truck.dbc monitor -i socketcan -c can0
  python -m typedcan --protocol acme.can send Engine_Status speed=1200 -i virtual -c 0

exit status: 0 all is well, 1 a log does not conform, 2 the command could not do its work, 3 a log
is damaged: what could be read was used"""

_COMMAND_EXAMPLES = {
    "decode": """  python -m typedcan --dbc truck.dbc decode drive.blf
  python -m typedcan --protocol acme.can decode drive.asc --json""",
    "convert": """  python -m typedcan --dbc truck.dbc convert drive.blf -o drive.parquet
  python -m typedcan --dbc truck.kcd convert drive.asc -o drive.csv --raster 100ms""",
    "plot": """  python -m typedcan --dbc truck.dbc plot drive.blf --signals Speed -o speed.html""",
    "conform": """  python -m typedcan --dbc truck.dbc conform drive.blf
  python -m typedcan --protocol acme.can conform drive.asc --html report.html --junit report.xml
  python -m typedcan --dbc truck.dbc conform -i socketcan -c can0 --duration 60s

Judged by what the protocol says of its messages: identifier, length, period, checksum, counter,
codes, ranges, reserved bits, requests, groups of readings.

exit status: 0 it conforms, 1 it does not, 2 it could not be judged, or not all of it""",
    "listen": """  python -m typedcan --dbc truck.dbc listen -i socketcan -c can0 --seconds 10""",
    "monitor": """  python -m typedcan --dbc truck.dbc monitor -i socketcan -c can0
  python -m typedcan --protocol acme.can monitor -i socketcan -c can0 --record drive.blf
  python -m typedcan --dbc truck.dbc monitor -i socketcan -c can0 --json --interval 5""",
    "send": """  python -m typedcan --dbc truck.dbc send Engine_Status speed=1200 -i virtual -c 0

A database does not say which codes make something move: on a bus that is not virtual nothing of
it is sent without the last option. A generated package may say it.""",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line with the arguments of this process; return its exit status."""
    print_warnings()
    try:
        return command_line.run(PROGRAM, sys.argv[1:] if arguments is None else arguments)
    except KeyboardInterrupt:  # before a command began, or a second one
        return 130


def _add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--protocol",
        metavar="PACKAGE",
        help="a package that `dbcspec generate` wrote: its name, or its folder",
    )
    completing_files(
        parser.add_argument(
            "--dbc", type=Path, metavar="FILE", help="a database: .dbc, .kcd, .sym or .arxml"
        )
    )


def _add(commands: Subcommands[Parser], name: str) -> None:
    from typedcan.commands.package import named_package
    from typedcan.commands.tool import Tool

    tool = Tool(
        program=PROGRAM.name,
        own=lambda options: named_package(options.protocol) if options.protocol else None,
        help=_HELP,
        examples=_COMMAND_EXAMPLES,
    )
    import_module(f"typedcan.commands.{name}").command(tool).add(commands)


PROGRAM = Program(
    name="python -m typedcan",
    description="Any CAN protocol: decode, convert and judge logs, watch a bus, send a message.",
    epilog=_EXAMPLES,
    commands=_HELP,
    add=_add,
    add_options=_add_options,
)


if __name__ == "__main__":
    sys.exit(main())
