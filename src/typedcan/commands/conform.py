"""`conform`: whether what is in logs, or on a bus, keeps to a protocol."""

from __future__ import annotations

import argparse
import re
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from typedcan.commands.bus_options import add_bus_options
from typedcan.commands.log_options import add_window_options, need
from typedcan.commands.tool import Tool, add_protocol_options
from typedcan.shell.command_line import Command, completing_files
from typedcan.simulate.times import PlanError, seconds_of


def command(tool: Tool) -> Command:
    """The command of a command line that judges by the rules that a protocol gives."""
    return tool.command("conform", _add_arguments, partial(_run, tool))


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    add_log_options(parser)
    add_protocol_options(parser)
    add_listening(parser)
    add_bus_options(parser)


def _run(tool: Tool, options: argparse.Namespace) -> int:
    need("numpy")
    from typedcan.commands.conformance import judging_of, run

    return run(judging_of(tool.program, tool.protocol(options)), options)


def add_log_options(parser: argparse.ArgumentParser, nodes: Sequence[str] = ()) -> None:
    """Add the logs, what is judged and by what, and the reports; ``nodes`` are those known."""
    logs = parser.add_argument(
        "logs",
        type=Path,
        nargs="*",
        metavar="LOG",
        help="logs, each judged by itself: .asc, .blf, .csv, .log, .trc, .mf4 and others;"
        " without any, a bus is judged",
    )
    completing_files(logs)
    _add_choice(parser, nodes)
    _add_reports(parser)
    add_window_options(parser)


def _add_choice(parser: argparse.ArgumentParser, nodes: Sequence[str]) -> None:
    group = parser.add_argument_group("what is judged")
    group.add_argument(
        "--judge",
        type=names,
        action="extend",
        default=[],
        metavar="NODE,...",
        help=f"these nodes only{', of ' if nodes else ''}{', '.join(nodes)}; each has to be there"
        " (default: all that are there)",
    )
    for name, text in (("--only", "by these rules only"), ("--skip", "not by these rules")):
        group.add_argument(
            name, type=names, action="extend", default=[], metavar="RULE,...", help=text
        )
    group.add_argument(
        "--tolerance",
        dest="tolerances",
        type=_tolerance,
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="another value than a rule's own for what it allows",
    )
    group.add_argument(
        "--strict", action="store_true", help="a recommendation counts like a demand"
    )
    group.add_argument("--list-rules", action="store_true", help="show the rules")
    group.add_argument(
        "--list-tolerances", action="store_true", help="show what they allow, and its name"
    )


def _add_reports(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("reports", "A file that is there already is replaced.")
    for name, text in (
        ("--html", "a page with plots, for people"),
        ("--junit", "JUnit XML, for CI servers"),
        ("--csv", "a table with a row per finding, and per rule that was not judged"),
    ):
        completing_files(group.add_argument(name, type=Path, metavar="FILE", help=text))
    group.add_argument("--json", action="store_true", help="print JSON in place of the summary")
    group.add_argument(
        "--language",
        choices=("en", "zh"),
        default="en",
        help="of summary and reports (default: en)",
    )
    group.add_argument(
        "-v", "--verbose", action="store_true", help="name the rules that nothing breaks too"
    )


def add_listening(parser: argparse.ArgumentParser, more: str = "") -> None:
    """Add how long to listen to a bus, and where to keep the record; ``more`` is said of it too."""
    group = parser.add_argument_group(
        "a bus", "It is recorded, then the record is judged. Ctrl-C ends the recording early."
    )
    group.add_argument(
        "--duration",
        type=_duration,
        metavar="TIME",
        help="listen for so long: 60s, 500ms, 5m; a plain number is seconds (default: 1m)",
    )
    completing_files(
        group.add_argument(
            "--record",
            type=Path,
            metavar="FILE",
            help=f"keep the record, in the format of the suffix, such as bench.blf{more}",
        )
    )


def names(text: str) -> list[str]:
    """Names with commas between them, as the type of an argument."""
    return [name.strip() for name in text.split(",") if name.strip()]


def _tolerance(text: str) -> tuple[str, float]:
    name, equals, value = text.partition("=")
    # Not all that Python takes for a number: neither inf nor nan, nor 1_000.
    if not (equals and re.fullmatch(r"[0-9]+(\.[0-9]+)?([eE][-+]?[0-9]+)?", value.strip())):
        raise argparse.ArgumentTypeError(f"expected NAME=NUMBER, not {text!r}")
    return name.strip(), float(value)


def _duration(text: str) -> float:
    try:
        seconds = seconds_of(re.sub(r"(?<=[0-9 ])m$", "min", text.strip()))
    except PlanError as error:
        raise argparse.ArgumentTypeError(str(error)) from None
    if not seconds:
        raise argparse.ArgumentTypeError("expected a time longer than none")
    return seconds
