"""`swapcan decode`: the messages in a log file."""

from __future__ import annotations

import argparse
from pathlib import Path

from swapcan.commands import HELP
from swapcan.commands.log_file import LogFileError, read_log
from swapcan.commands.transcript import JSON_HELP, Transcript
from typedcan.shell.command_line import Command
from typedcan.shell.console import CommandError, note

# What shtab calls a file, for the completion of shells.
_FILE = {"bash": "_shtab_compgen_files", "zsh": "_files", "tcsh": "f"}


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    file = parser.add_argument(
        "file",
        type=Path,
        metavar="LOGFILE",
        help="any log that python-can reads: .asc, .blf, .csv, .db, .log, .trc, .mf4, or .asc.gz",
    )
    vars(file)["complete"] = _FILE
    parser.add_argument("--json", action="store_true", help=JSON_HELP)


def _run(options: argparse.Namespace) -> int:
    transcript = Transcript(as_json=options.json)
    try:
        for frame in read_log(options.file):
            transcript.show(frame)
    except LogFileError as error:
        raise CommandError(f"{error}; read: {transcript.summary()}") from None
    note(transcript.summary())
    return 0


COMMAND = Command(
    name="decode",
    help=HELP["decode"],
    examples="""  swapcan decode drive.blf
  swapcan decode drive.asc --json | jq -c '.signals.B2V_ST2_SOC // empty'""",
    add_arguments=_add_arguments,
    run=_run,
)
