"""`dbcspec load`: how full the buses are, and whether every message is always in time."""

from __future__ import annotations

import argparse
from fractions import Fraction
from pathlib import Path

from dbcspec.commands import HELP
from dbcspec.commands.common import Commands, project_option, source_protocol
from dbcspec.load.analysis import BusLoad, analyse
from dbcspec.load.plot import svg
from dbcspec.load.tables import data, text
from dbcspec.load.traffic import Scenario, Size
from typedcan.model.errors import ReadError
from typedcan.model.protocol import Bus, Protocol
from typedcan.shell.console import say_text
from typedcan.shell.files import put_in_place
from typedcan.shell.printing import printable, printable_json

_EXAMPLES = """examples:
  dbcspec load --groups 18 --items cell_voltages=216 --items probe_temperatures=108
  dbcspec load --bus vehicle --event-interval 100 --plot load.svg
  dbcspec load vehicle.dbc --bit-rate 500000 --json

exit status: 0 every message is always in time, 1 one can miss its period, 2 no answer"""


def add(commands: Commands) -> None:
    """Declare the command."""
    short = HELP["load"]
    parser = commands.add_parser("load", help=short, description=f"{short.capitalize()}.")
    parser.epilog = _EXAMPLES
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.set_defaults(run=_run)
    project_option(parser)
    parser.add_argument("source", nargs="?", help="a DBC, matrix or spec (default: the project)")
    parser.add_argument("--encoding", help="of that file, where it is not to be found out")
    parser.add_argument("--bus", help="this bus only (default: all)")
    parser.add_argument("--bit-rate", type=_positive, help="in bit/s, for a file that names no bus")
    parser.add_argument(
        "--groups", type=_positive, default=1, help="groups of each transfer, such as CSCs"
    )
    parser.add_argument(
        "--items",
        type=_items,
        action="append",
        default=[],
        metavar="TRANSFER=N",
        help="items of a transfer in all, such as cell_voltages=216",
    )
    parser.add_argument(
        "--always-only",
        action="store_true",
        help="without messages that are sent while a condition holds",
    )
    parser.add_argument(
        "--event-interval",
        type=_positive,
        metavar="MS",
        help="count event messages too, each as often as this",
    )
    parser.add_argument("--plot", type=Path, metavar="FILE.svg", help="draw the response times")
    parser.add_argument("--json", action="store_true", help="print JSON")


def _run(options: argparse.Namespace) -> int:
    protocol = source_protocol(options)
    scenario = _scenario(options, protocol)
    loads = [analyse(protocol, bus, scenario) for bus in _buses(options, protocol)]
    if options.plot:
        put_in_place(_pictures(options.plot, loads))
    if options.json:
        say_text(printable_json([data(load) for load in loads], indent=2))
    else:
        say_text("\n\n".join("\n".join(map(printable, text(load))) for load in loads))
    return 1 if any(load.late for load in loads) else 0


def _scenario(options: argparse.Namespace, protocol: Protocol) -> Scenario:
    known = [transfer.name for transfer in protocol.transfers]
    sizes = {name: Size(options.groups, options.groups) for name in known}
    for name, items in options.items:
        if name not in known:
            raise ReadError(f"there is no transfer {name!r}; known: {', '.join(known) or 'none'}")
        sizes[name] = Size(options.groups, items)
    interval = options.event_interval
    return Scenario(
        sizes=sizes,
        conditional=not options.always_only,
        event_interval=None if interval is None else Fraction(interval, 1000),
    )


def _buses(options: argparse.Namespace, protocol: Protocol) -> list[Bus]:
    buses = list(protocol.buses)
    if not buses:
        if options.bit_rate is None:
            raise ReadError("the file names no bus: give its bit rate with --bit-rate")
        buses = [Bus(name="bus", bit_rate=options.bit_rate, nodes=())]
    if options.bus is None:
        return buses
    chosen = [bus for bus in buses if bus.name == options.bus]
    if not chosen:
        known = ", ".join(bus.name for bus in buses)
        raise ReadError(f"there is no bus {options.bus!r}; known: {known}")
    return chosen


def _pictures(path: Path, loads: list[BusLoad]) -> dict[Path, bytes]:
    """A file per bus: under the name given where there is one bus, else with the bus's name."""
    if len(loads) == 1:
        return {path: svg(loads[0]).encode("utf-8")}
    return {
        path.with_stem(f"{path.stem}-{load.bus.name}"): svg(load).encode("utf-8") for load in loads
    }


def _positive(text: str) -> int:
    if not (text.isdecimal() and int(text)):
        raise argparse.ArgumentTypeError(f"expected a positive whole number, not {text!r}")
    return int(text)


def _items(text: str) -> tuple[str, int]:
    name, equals, number = text.partition("=")
    if not (name and equals):
        raise argparse.ArgumentTypeError(f"expected TRANSFER=N, not {text!r}")
    return name, _positive(number)
