"""`decode`: the messages in a log file."""

from __future__ import annotations

import argparse
from functools import partial
from pathlib import Path

from typedcan.commands.log_file import LogFileError, read_log
from typedcan.commands.tool import Tool, add_protocol_options
from typedcan.commands.transcript import JSON_HELP, Transcript
from typedcan.shell.command_line import Command, completing_files
from typedcan.shell.console import CommandError, note


def command(tool: Tool) -> Command:
    """The command of a command line."""
    return tool.command("decode", _add_arguments, partial(_run, tool))


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    file = parser.add_argument(
        "file",
        type=Path,
        metavar="LOGFILE",
        help="any log that python-can reads: .asc, .blf, .csv, .db, .log, .trc, .mf4, or .asc.gz",
    )
    completing_files(file)
    add_protocol_options(parser)
    parser.add_argument("--json", action="store_true", help=JSON_HELP)


def _run(tool: Tool, options: argparse.Namespace) -> int:
    transcript = Transcript(tool.codec(options), as_json=options.json)
    try:
        for frame in read_log(options.file):
            transcript.show(frame)
    except LogFileError as error:
        raise CommandError(f"{error}; read: {transcript.summary()}") from None
    note(transcript.summary())
    return 0
