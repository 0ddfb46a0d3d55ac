"""`plot`: signals of a log over time, and readings as heat maps."""

from __future__ import annotations

import argparse
from functools import partial
from pathlib import Path

from typedcan.commands.log_options import add_window_options, need
from typedcan.commands.tool import Tool, add_protocol_options
from typedcan.shell.command_line import Command, completing_files


def command(tool: Tool) -> Command:
    """The command of a command line."""
    return tool.command("plot", partial(_add_arguments, tool), partial(_run, tool))


def _add_arguments(tool: Tool, parser: argparse.ArgumentParser) -> None:
    log = parser.add_argument(
        "log",
        type=Path,
        metavar="LOG",
        help="any log: .asc, .blf, .csv, .log, .trc, .mf4 and others",
    )
    output = parser.add_argument(
        "-o",
        "--output",
        type=Path,
        required=True,
        metavar="OUT",
        help=".html: a page to zoom and to read values off; .png: a picture, needs matplotlib",
    )
    add_protocol_options(parser)
    completing_files(log, output)
    parser.add_argument(
        "--signals",
        type=_names,
        action="extend",
        default=[],
        metavar="NAME,...",
        help="Speed means the one signal that ends in _Speed; patterns like '*_Fault_*' are taken",
    )
    parser.add_argument(
        "--readings",
        type=_names,
        action="extend",
        default=[],
        metavar="NAME,...",
        help="what comes over several frames, as heat maps: the names of its tables",
    )
    for transfer, (table, item) in tool.tables.items():
        text = f"{transfer.replace('_', ' ')} as a heat map, a row for each {item}"
        parser.add_argument(
            f"--{table}", action="append_const", dest="readings", const=table, help=text
        )
    add_window_options(parser)
    parser.add_argument("--force", action="store_true", help="replace OUT where it exists")


def _names(text: str) -> list[str]:
    return [name.strip() for name in text.split(",") if name.strip()]


def _run(tool: Tool, options: argparse.Namespace) -> int:
    need("numpy")
    from typedcan.commands.plotting import run

    return run(tool, options)
