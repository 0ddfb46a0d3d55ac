"""The options that the commands for whole logs share, and the check for their extra."""

from __future__ import annotations

import argparse
from importlib.util import find_spec
from pathlib import Path

from typedcan.shell.console import CommandError

# What shtab calls a file, for the completion of shells.
_FILE = {"bash": "_shtab_compgen_files", "zsh": "_files", "tcsh": "f"}


def completing_files(*arguments: argparse.Action) -> None:
    """Let the shell complete these by the names of files."""
    for each in arguments:
        vars(each)["complete"] = _FILE


def add_dbc_option(parser: argparse.ArgumentParser) -> None:
    """Add --dbc."""
    completing_files(
        parser.add_argument("--dbc", type=Path, metavar="FILE", help="decode by this DBC file")
    )


def add_window_options(parser: argparse.ArgumentParser) -> None:
    """Add --from and --to."""
    parser.add_argument(
        "--from",
        dest="start",
        metavar="TIME",
        help="seconds since the log's begin, or a date like 2025-06-30T14:05:00 (local time)",
    )
    parser.add_argument("--to", dest="end", metavar="TIME", help="the same")


def need(*packages: str) -> None:
    """Raise `CommandError` where a package of the extra ``logs`` is not installed."""
    for name in packages:
        if find_spec(name) is None:
            raise CommandError(f"this needs {name}: pip install 'swapcan[logs]'")
