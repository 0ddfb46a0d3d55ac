"""`swapcan simulate`: nodes of the protocol that are not there, on a real bus, in real time."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from contextlib import ExitStack
from typing import TypeVar

from swapcan._generated.protocol import PROTOCOL
from swapcan.commands import HELP
from swapcan.commands.simulate_run import LivingNodes, allowed_nodes
from swapcan.commands.tool import codec_of
from swapcan.nodes.faults import FAULTS, able_nodes, planned_fault
from swapcan.nodes.plan import DEFAULT_PLAN, STEPS, PlannedStep, plan_of
from swapcan.nodes.simulation import check
from typedcan.commands.bus_options import (
    add_bus_options,
    add_consent,
    assignment,
    bus_name,
    is_virtual,
    open_bus,
)
from typedcan.commands.tool import add_choice_options
from typedcan.shell.algorithms import add_algorithm_option
from typedcan.shell.command_line import Command
from typedcan.shell.console import say, seconds
from typedcan.shell.printing import aligned
from typedcan.shell.process_signals import Interrupts
from typedcan.simulate.times import PlanError

T = TypeVar("T")


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    names = ", ".join(PROTOCOL.nodes)
    parser.add_argument(
        "nodes",
        nargs="*",
        type=str.upper,
        metavar="NODE",
        help=f"which to simulate, of {names} (default: all)",
    )
    parser.add_argument(
        "--fault",
        dest="faults",
        action="append",
        type=_typed(planned_fault),
        default=[],
        metavar="[WHO.]NAME@START[+DURATION]",
        help="such as over_temperature@30s, VCU.bus_silence@1min+2s, B2V_ST1.lost_frame@500ms;"
        " WHO is a node or a message",
    )
    parser.add_argument("--list-faults", action="store_true", help="show which faults there are")
    parser.add_argument(
        "--plan",
        type=_typed(plan_of),
        metavar="STEP@START[+DURATION],...",
        help=f"what the nodes do, of {', '.join(STEPS)}; empty for nothing"
        f" (default with the VCU: {', '.join(map(str, DEFAULT_PLAN))})",
    )
    parser.add_argument("--seconds", type=seconds, default=math.inf, help="end after so long")
    parser.add_argument("--seed", type=int, default=0, help="what chance is drawn from")
    parser.add_argument(
        "--sleep",
        action="store_true",
        help="let the BMU sleep three seconds after it was switched off (5.2.1.4), until it is"
        " commanded on or a charger comes",
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object a line")
    add_consent(
        parser,
        "really be VCU and BMU on a bus where somebody may obey: high voltage comes on, chargers"
        " and cooling start; without it they are left out, save on the virtual interface",
    )
    add_choice_options(parser)
    add_algorithm_option(parser)
    add_bus_options(parser)
    parser.add_argument(
        "--charger-bus",
        nargs="+",
        action="extend",
        type=assignment,
        default=[],
        metavar="NAME=VALUE",
        help="another bus for BMU and CHG to talk on: interface, channel and so on, where they are"
        " not those of the bus above (default: the same bus)",
    )


def _typed(read: Callable[[str], T]) -> Callable[[str], T]:
    """The same as the type of an argument."""

    def typed(text: str) -> T:
        try:
            return read(text)
        except PlanError as error:
            raise argparse.ArgumentTypeError(str(error)) from None

    return typed


def _run(options: argparse.Namespace) -> int:
    if options.list_faults:
        _list_faults()
        return 0
    names = tuple(options.nodes) or PROTOCOL.nodes
    check(names, options.plan or (), options.faults)
    codec = codec_of(options)  # refuses what there is not before a bus is opened
    named = [options, *([_charger_options(options)] if options.charger_bus else [])]
    virtual = all(map(is_virtual, named))
    if not virtual and not options.yes_drive_the_bus:
        names = allowed_nodes(codec.protocol, names, options.plan or (), options.faults)
    plan = _default_plan(names) if options.plan is None else options.plan
    with ExitStack() as stack:
        interrupts = stack.enter_context(Interrupts())
        buses = [stack.enter_context(open_bus(each, virtual=virtual)) for each in named]
        name = bus_name(buses[0], options)
        nodes = LivingNodes(options, names, plan, buses, name, codec, virtual=virtual)
        nodes.live(interrupts)
    interrupts.stop_if_asked()
    return interrupts.status or (0 if nodes.is_safe else 2)


def _default_plan(names: tuple[str, ...]) -> tuple[PlannedStep, ...]:
    """What is done where nothing else is said: without the VCU nothing."""
    return tuple(step for step in DEFAULT_PLAN if step.node in names and "VCU" in names)


def _charger_options(options: argparse.Namespace) -> argparse.Namespace:
    named = {name: getattr(options, name) for name in ("interface", "channel", "bitrate")}
    given = dict(options.charger_bus)
    own = {name: given.pop(name, value) for name, value in named.items()}
    return argparse.Namespace(**own, bus_kwargs=[*options.bus_kwargs, *given.items()])


def _list_faults() -> None:
    rows = [(name, ", ".join(able_nodes(name)), kind.text) for name, kind in FAULTS.items()]
    for line in aligned(("fault", "nodes", "what happens"), rows):
        say(line)


COMMAND = Command(
    name="simulate",
    help=HELP["simulate"],
    examples="""  swapcan simulate -i virtual -c 0
  swapcan simulate CHG TMS BSU -i socketcan -c can0
  swapcan simulate VCU -i socketcan -c can0 --plan "hv_on@1s, hv_off@60s" --yes-drive-the-bus
  swapcan simulate BMU -i pcan -c PCAN_USBBUS1 --fault over_temperature@30s --yes-drive-the-bus
  swapcan simulate BMU TMS BSU --edition v4.6 -i socketcan -c can0 --yes-drive-the-bus
  swapcan simulate --list-faults

VCU and BMU, which make others act, first look for two seconds whether somebody else sends their
messages, and end where somebody does, then or later. However it ends, by an error, Ctrl-C, Ctrl-Z
or another signal, the safe codes of what they have commanded are sent first, as long as the bus
takes them. What cannot be caught is SIGKILL, a crash, a power cut, a frozen machine and a driver
that hangs: then what is commanded holds until its receiver's own timeout, which the standard does
not give. Switching high voltage off at speed opens contactors under load.

Where a message comes that only another edition has than the chosen one, VCU and BMU end too: the
same code can mean the opposite there. Signals that editions disagree about are left invalid, unless
--edition says which is spoken.

exit status: 0 the time was over, 2 it could not go on, or was not left safe, 128 and its number
where a signal has ended it""",
    add_arguments=_add_arguments,
    run=_run,
)
