"""`swapcan conform`: whether what is in a log, or on a bus, keeps to the standard."""

from __future__ import annotations

import argparse

from swapcan._generated.protocol import PROTOCOL
from swapcan.commands import HELP
from typedcan.commands.bus_options import add_bus_options
from typedcan.commands.conform import add_listening, add_log_options, names
from typedcan.commands.log_options import need
from typedcan.shell.algorithms import add_algorithm_option
from typedcan.shell.command_line import Command


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    add_log_options(parser, PROTOCOL.nodes)
    add_listening(parser, "; with several scenarios one file each, such as bench-hv-on-off.blf")
    _add_driving(parser)
    add_algorithm_option(parser)
    add_bus_options(parser)


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
        type=names,
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


def _nodes(text: str) -> list[str]:
    return [name.upper() for name in names(text)]


def _run(options: argparse.Namespace) -> int:
    need("numpy")
    from swapcan.commands.conform_driving import run

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
