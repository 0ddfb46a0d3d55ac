"""`swapcan demo`: a pack and a truck talk on a virtual bus, in every message of the protocol."""

from __future__ import annotations

import argparse
import secrets
from contextlib import ExitStack

import can

from swapcan._generated.protocol import PROTOCOL
from swapcan.commands import HELP
from swapcan.commands.tool import codec_of
from swapcan.commands.traffic import Traffic
from swapcan.messages import B2V_ST1
from swapcan.simulate import PlannedStep, Simulation
from swapcan.wire import Link, database
from typedcan.commands.tool import add_choice_options
from typedcan.shell.algorithms import add_algorithm_option, algorithms_of
from typedcan.shell.command_line import Command
from typedcan.shell.console import note, say, seconds
from typedcan.spoken.codec import words_of
from typedcan.wire.errors import ReceiveTimeoutError
from typedcan.wire.link import Received
from typedcan.wire.message import Message


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--seconds", type=seconds, default=4.0, help="how long (default: 4)")
    add_choice_options(parser)
    add_algorithm_option(parser)


def _run(options: argparse.Namespace) -> int:
    note(f"pack and truck talk for {options.seconds:g} s, Ctrl-C ends")
    codec = codec_of(options)
    traffic = Traffic([*map(words_of(codec).own, codec.protocol.messages)])
    database(codec.protocol)  # read before the clock starts
    with ExitStack() as stack:
        run = secrets.token_hex(4)
        vehicle, charger = f"swapcan-vehicle-{run}", f"swapcan-charger-{run}"
        listeners = [
            Link(stack.enter_context(_bus(name)), codec=codec) for name in (vehicle, charger)
        ]
        simulation = stack.enter_context(
            Simulation(
                PROTOCOL.nodes,
                lambda: _bus(vehicle),
                lambda: _bus(charger),
                plan=_plan(options.seconds),
                algorithms=algorithms_of(options),
                codec=codec,
            )
        )
        simulation.world.after_each_step(lambda: _hear(listeners, traffic))
        simulation.world.run(options.seconds)
        faults = sum(link.counts.faults for link in listeners)
        nodes = [node for each in simulation.participants.values() for node in each.nodes]
        faults += sum(node.counts.faults for node in nodes)
    return _tell(simulation, traffic, faults)


def _plan(duration: float) -> tuple[PlannedStep, ...]:
    """High voltage on and data asked for; the charger is connected from the beginning."""
    return PlannedStep("hv_on", 0.0), PlannedStep("ask", 0.1 * duration)


def _bus(channel: str) -> can.BusABC:
    return can.Bus(channel, "virtual", ignore_config=True)


def _hear(listeners: list[Link], traffic: Traffic) -> None:
    for listener in listeners:
        while received := _arrived(listener):
            traffic.add(received)


def _arrived(link: Link) -> Received[Message] | None:
    try:
        return link.receive(timeout=0)
    except ReceiveTimeoutError:
        return None


def _tell(simulation: Simulation, traffic: Traffic, faults: int) -> int:
    bmu, vcu = simulation.bmu, simulation.vcu
    for line in (*traffic.message_table(), "", *traffic.signal_table()):
        say(line)
    states = map(B2V_ST1.FIELDS["bms"].text, vcu.states if vcu else ())
    code = vcu.pack_code if vcu else None
    missing = [kind.NAME for kind in traffic.expected if kind not in traffic.kinds]
    say("")
    say(f"VIN at the pack         {bmu.vin if bmu else ''}")
    say(f"pack code at the truck  {code.result(0) if code and code.done() else 'not yet'}")
    say(f"high voltage            {', '.join(states)}")
    say(f"messages                {len(traffic.kinds)} of {len(traffic.expected)}")
    say(f"frames                  {traffic.frames}")
    say(f"faults                  {faults}")
    if missing:
        note(f"not received: {', '.join(missing)}")
    return 1 if missing or faults else 0


COMMAND = Command(
    name="demo",
    help=HELP["demo"],
    examples="""  swapcan demo
  swapcan demo --seconds 10
  swapcan demo --edition v4.6""",
    add_arguments=_add_arguments,
    run=_run,
)
