"""`swapcan conform`: whether what is in a log, or on a bus, keeps to the standard."""

from __future__ import annotations

import argparse
import re
from pathlib import Path

from swapcan._generated.protocol import PROTOCOL
from swapcan.commands import HELP
from typedcan.commands.bus_options import add_bus_options
from typedcan.commands.log_options import add_window_options, need
from typedcan.commands.tool import completing_files
from typedcan.shell.command_line import Command
from typedcan.simulate.times import PlanError, seconds_of


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    logs = parser.add_argument(
        "logs",
        type=Path,
        nargs="*",
        metavar="LOG",
        help="logs, each judged by itself: .asc, .blf, .csv, .log, .trc, .mf4 and others;"
        " without any, a bus is judged",
    )
    completing_files(logs)
    _add_choice(parser)
    _add_reports(parser)
    add_window_options(parser)
    _add_live(parser)
    _add_driving(parser)
    add_bus_options(parser)


def _add_choice(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("what is judged")
    group.add_argument(
        "--judge",
        type=_nodes,
        action="extend",
        default=[],
        metavar="NODE,...",
        help=f"these nodes only, of {', '.join(PROTOCOL.nodes)}; each has to be there"
        " (default: all that are there)",
    )
    for name, text in (("--only", "by these rules only"), ("--skip", "not by these rules")):
        group.add_argument(
            name, type=_names, action="extend", default=[], metavar="RULE,...", help=text
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
        ("--csv", "a table with a row per finding"),
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


def _add_live(parser: argparse.ArgumentParser) -> None:
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
            help="keep the record, in the format of the suffix, such as bench.blf; with several"
            " scenarios one file each, such as bench-hv-on-off.blf",
        )
    )


def _add_driving(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group(
        "driving a pack",
        "However it ends, by an error, Ctrl-C, Ctrl-Z or another signal, the pack is told first\n"
        "to switch off, as long as the bus takes that, and a line says whether it has reported\n"
        "that it did. What cannot be caught is SIGKILL, a crash, a power cut, a frozen machine\n"
        "and a driver that hangs: then the last command holds until the pack's own timeout,\n"
        "which the standard does not give. Switching high voltage off at speed opens contactors\n"
        "under load.",
    )
    group.add_argument(
        "--active",
        type=_names,
        action="extend",
        default=[],
        metavar="SCENARIO,...",
        help="DRIVE the pack on the bus through scenarios: play its VCU or charger, switch high"
        " voltage; see --list-scenarios",
    )
    group.add_argument(
        "--play",
        type=_nodes,
        action="extend",
        default=[],
        metavar="NODE,...",
        help="the nodes that scenarios play, where others than their own",
    )
    group.add_argument(
        "--yes-drive-the-bus",
        action="store_true",
        help="really send what --active announces; contactors may close",
    )
    group.add_argument(
        "--list-scenarios", action="store_true", help="show them, and exactly what each sends"
    )


def _names(text: str) -> list[str]:
    return [name.strip() for name in text.split(",") if name.strip()]


def _nodes(text: str) -> list[str]:
    return [name.upper() for name in _names(text)]


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


def _run(options: argparse.Namespace) -> int:
    need("numpy")
    from swapcan.commands.conformance import run

    return run(options)


COMMAND = Command(
    name="conform",
    help=HELP["conform"],
    examples="""  swapcan conform drive.blf
  swapcan conform day-*.asc --judge BMU --html report.html --junit report.xml
  swapcan conform drive.blf --tolerance period-mean.share=0.2 --skip checksum --strict
  swapcan conform -i socketcan -c can0 --duration 5m --judge BMU --record bench.blf
  swapcan conform -i socketcan -c can0 --active hv-on-off --yes-drive-the-bus
  swapcan conform --list-rules --language zh

exit status: 0 it conforms, 1 it does not, 2 it could not be judged, or not all of it: a log is
damaged, a node is not there, the pack did not report that it is off, the command could not do its
work; 130 interrupted twice, 128 and its number ended by another signal""",
    add_arguments=_add_arguments,
    run=_run,
)
