"""A process of its own with simulated nodes, whose clock another process advances.

Reads lines such as ``0.25`` from stdin: live up to that second. Answers each with a line of JSON
on stdout: the frames sent so far, those received from others, and what the nodes do.
"""

from __future__ import annotations

import json
import sys

import can

from swapcan.nodes.plan import plan_of
from swapcan.nodes.simulation import Simulation
from typedcan.node.clock import SimulatedClock
from typedcan.simulate.shared_bus import SharedBus


def main(names: str, plan: str, bus_options: str) -> None:
    """Live with some nodes on a bus until stdin ends."""
    with can.Bus(ignore_config=True, **json.loads(bus_options)) as bus:
        shared = SharedBus(bus)
        clock = SimulatedClock()
        with Simulation(
            names.split(","), shared.share, plan=plan_of(plan), clock=clock
        ) as simulation:
            print("ready", flush=True)
            for line in sys.stdin:
                simulation.world.run(max(0.0, float(line) - simulation.world.elapsed))
                participants = simulation.participants.values()
                answer = {
                    "sent": shared.sent,
                    "received": shared.received,
                    "status": [each.status for each in participants],
                    "faults": sum(
                        node.counts.faults for each in participants for node in each.nodes
                    ),
                }
                print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
