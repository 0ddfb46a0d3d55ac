"""`swapcan demo`: a pack and a truck talk on a virtual bus, in every message of the protocol."""

from __future__ import annotations

import argparse
import secrets
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack

import can

from swapcan.bus import Link
from swapcan.commands.nodes import Node, arrived
from swapcan.commands.pack import Pack
from swapcan.commands.traffic import Traffic
from swapcan.commands.truck import Charger, CoolingUnit, SwapController, Truck
from swapcan.console import Command, note, say, seconds
from swapcan.database import database
from swapcan.messages import B2V_ST1, MESSAGES

_LONGEST_SLEEP = 0.01
"""Seconds until what arrived is reacted to."""


class _World:
    """All nodes on their buses, and somebody who listens on each bus."""

    def __init__(self, open_buses: ExitStack, duration: float) -> None:
        self._open_buses = open_buses
        run = secrets.token_hex(4)
        vehicle, charger = f"swapcan-vehicle-{run}", f"swapcan-charger-{run}"
        self.listeners = [self._link(vehicle), self._link(charger)]
        self.truck = Truck(self._link(vehicle), hv_on_at=0.2 * duration, content_at=0.7 * duration)
        self.pack = Pack(self._link(vehicle), self._link(charger), precharge=0.3 * duration)
        self.nodes: Sequence[Node] = (
            self.truck,
            self.pack,
            SwapController(self._link(vehicle)),
            CoolingUnit(self._link(vehicle)),
            Charger(self._link(charger)),
        )

    def _link(self, channel: str) -> Link:
        bus = can.Bus(channel, "virtual", ignore_config=True)
        return Link(self._open_buses.enter_context(bus))

    def links(self) -> Iterator[Link]:
        """All links."""
        yield from self.listeners
        for node in self.nodes:
            yield from node.links

    def run(self, duration: float, traffic: Traffic) -> None:
        """Let the nodes talk for so many seconds."""
        database()  # read before the clock starts
        start = time.monotonic()
        while (now := time.monotonic() - start) < duration:
            for node in self.nodes:
                node.turn(now)
            for listener in self.listeners:
                for received in arrived(listener):
                    traffic.add(received)
            pause = min(node.next_due for node in self.nodes) - (time.monotonic() - start)
            time.sleep(min(max(pause, 0.0), _LONGEST_SLEEP))


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--seconds", type=seconds, default=3.0, help="how long (default: 3)")


def _run(options: argparse.Namespace) -> int:
    traffic = Traffic()
    note(f"pack and truck talk for {options.seconds:g} s, Ctrl-C ends")
    with ExitStack() as open_buses:
        world = _World(open_buses, options.seconds)
        world.run(options.seconds, traffic)
        faults = sum(link.counts.faults for link in world.links())
    for line in (*traffic.message_table(), "", *traffic.signal_table()):
        say(line)
    states = map(B2V_ST1.FIELDS["bms"].text, world.truck.states)
    missing = [kind.NAME for kind in MESSAGES if kind not in traffic.kinds]
    say("")
    say(f"VIN at the pack         {world.pack.vin}")
    say(f"pack code at the truck  {world.truck.pack_code}")
    say(f"high voltage            {', '.join(states)}")
    say(f"messages                {len(traffic.kinds)} of {len(MESSAGES)}")
    say(f"frames                  {traffic.frames}")
    say(f"faults                  {faults}")
    if missing:
        note(f"not received: {', '.join(missing)}")
    return 1 if missing or faults else 0


COMMAND = Command(
    name="demo",
    help="let a pack and a truck talk on a virtual bus and show what was received",
    examples="""  swapcan demo
  swapcan demo --seconds 10""",
    add_arguments=_add_arguments,
    run=_run,
)
