"""`decode`: the messages in a log file."""

from __future__ import annotations

import argparse
from functools import partial
from pathlib import Path

from typedcan.commands.log_options import add_window_options, need
from typedcan.commands.shown import add_filters
from typedcan.commands.tool import Tool, add_protocol_options
from typedcan.commands.transcript import JSON_HELP
from typedcan.shell.command_line import Command, completing_files


def command(tool: Tool) -> Command:
    """The command of a command line."""
    return tool.command("decode", _add_arguments, partial(_run, tool))


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    file = parser.add_argument(
        "file", type=Path, metavar="LOGFILE", help="a log: .asc, .blf, .csv, .log, .trc, .mf4 …"
    )
    completing_files(file)
    add_protocol_options(parser)
    add_window_options(parser)
    add_filters(parser)
    parser.add_argument(
        "--follow", action="store_true", help="go on while the log grows; Ctrl-C ends"
    )
    parser.add_argument("--json", action="store_true", help=JSON_HELP)


def _run(tool: Tool, options: argparse.Namespace) -> int:
    need("numpy")
    from typedcan.commands.decoding import run

    return run(tool, options)
