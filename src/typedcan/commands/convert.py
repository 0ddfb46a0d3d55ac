"""`convert`: log files to tables."""

from __future__ import annotations

import argparse
from functools import partial
from pathlib import Path

from typedcan.commands.log_options import add_window_options, names, need
from typedcan.commands.tool import Tool, add_protocol_options
from typedcan.shell.command_line import Command, completing_files
from typedcan.shell.console import count


def command(tool: Tool) -> Command:
    """The command of a command line."""
    return tool.command("convert", _add_arguments, partial(_run, tool))


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    logs = parser.add_argument(
        "logs",
        type=Path,
        nargs="+",
        metavar="LOG",
        help="logs of one drive, in their order: .asc, .blf, .csv, .log, .trc, .mf4 and others",
    )
    output = parser.add_argument(
        "-o",
        "--output",
        type=Path,
        required=True,
        metavar="OUT",
        help=(
            "the suffix says which kind: .parquet, .arrow, .feather, .csv or .mf4. One table is "
            "that file; tables of several messages go into a folder, OUT without its suffix, as "
            "one file each. .mf4 holds all tables. Without a suffix: a folder of Parquet files. "
            "Where everything is converted, readings that come over several frames are columns too"
        ),
    )
    completing_files(logs, output)
    add_protocol_options(parser)
    _add_choice(parser)
    parser.add_argument(
        "--keep-faulty", action="store_true", help="keep frames with a wrong length or checksum"
    )
    parser.add_argument(
        "--jobs", type=count, metavar="N", help="logs read at a time (default: one per core)"
    )
    parser.add_argument("--force", action="store_true", help="replace OUT where it exists")
    parser.add_argument("--json", action="store_true", help="print the summary as JSON")


def _add_choice(parser: argparse.ArgumentParser) -> None:
    for name, text in (
        ("--messages", "these messages only"),
        ("--signals", "these signals only; Speed means every signal that ends in _Speed"),
    ):
        parser.add_argument(
            name, help=text, type=names, action="extend", default=[], metavar="NAME,..."
        )
    add_window_options(parser)
    values = parser.add_mutually_exclusive_group()
    values.add_argument("--raw", action="store_true", help="raw values, not scaled")
    values.add_argument("--labels", action="store_true", help="labels in place of their codes")
    layout = parser.add_mutually_exclusive_group()
    layout.add_argument("--long", action="store_true", help="one table with a row per signal")
    layout.add_argument(
        "--raster",
        metavar="STEP",
        help=(
            "one table with a row every so often (100ms, 1s, 1min) and a column per signal: the "
            "last value, nothing once it is older than 5 periods of its message"
        ),
    )


def _run(tool: Tool, options: argparse.Namespace) -> int:
    need("numpy", "pyarrow")
    from typedcan.commands.conversion import run

    return run(tool, options)
