"""`swapcan plot`: signals, cells and probes of a log over time."""

from __future__ import annotations

import argparse
from pathlib import Path

from swapcan.commands import HELP
from swapcan.commands.log_options import (
    add_dbc_option,
    add_window_options,
    completing_files,
    need,
)
from typedcan.shell.command_line import Command


def _add_arguments(parser: argparse.ArgumentParser) -> None:
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
    add_dbc_option(parser)
    completing_files(log, output)
    parser.add_argument(
        "--signals",
        type=_names,
        action="extend",
        default=[],
        metavar="NAME,...",
        help="SOC means the one signal that ends in _SOC; patterns like 'B2V_ST1_Flt_*' are taken",
    )
    parser.add_argument("--cells", action="store_true", help="cell voltages as a heat map")
    parser.add_argument("--probes", action="store_true", help="probe temperatures as a heat map")
    add_window_options(parser)
    parser.add_argument("--force", action="store_true", help="replace OUT where it exists")


def _names(text: str) -> list[str]:
    return [name.strip() for name in text.split(",") if name.strip()]


def _run(options: argparse.Namespace) -> int:
    need("numpy")
    from swapcan.commands.plotting import run

    return run(options)


COMMAND = Command(
    name="plot",
    help=HELP["plot"],
    examples="""  swapcan plot drive.blf --signals SOC,Current -o drive.html
  swapcan plot drive.blf --cells --probes -o cells.html
  swapcan plot drive.blf --signals 'B2V_ST0_ST_*' --from 60 --to 120 -o relays.png

exit status: 0 all is well, 2 the command could not do its work, 3 the log is damaged: what can be
read of it is drawn""",
    add_arguments=_add_arguments,
    run=_run,
)
