"""All five simulated nodes for one simulated day: whether memory stays as it is.

    python tests/benchmarks/simulated_day.py [--hours 24]

Once an hour the truck is switched on, drives, is charged and switched off. Prints every simulated
half hour the allocated memory blocks, the resident memory and the processor time. Nodes remember a
limited number of payloads, so that both go up and down; exits with 1 where the most of the second
half is more than the most of the first half by more than it may be. A day takes more than an hour
of processor time.
"""

from __future__ import annotations

import argparse
import gc
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from swapcan.nodes.plan import PlannedStep
from swapcan.nodes.simulation import Simulation

BLOCKS = 10_000
"""Memory blocks that may be more in the second half."""

BYTES = 4_000_000
"""The same for resident memory."""

_PAGE = 4096


@dataclass(frozen=True)
class Sample:
    """Memory at one moment: simulated seconds, allocated blocks, resident bytes, frames so far."""

    at: float
    blocks: int
    resident: int
    frames: int


def plan(hours: float) -> list[PlannedStep]:
    """Each hour: on, ask, 15 minutes of driving, 30 of charging, off."""
    steps = []
    for hour in range(int(hours) + 1):
        start = 3600.0 * hour
        steps += [
            PlannedStep("hv_on", start + 10),
            PlannedStep("ask", start + 15),
            PlannedStep("drive", start + 20, 900),
            PlannedStep("charge", start + 1200, 1800),
            PlannedStep("hv_off", start + 3300),
        ]
    return steps


def sample(simulation: Simulation) -> Sample:
    """Memory now, once what nobody uses any more is gone."""
    gc.collect()
    statm = Path("/proc/self/statm")
    resident = int(statm.read_text().split()[1]) * _PAGE if statm.exists() else 0
    frames = sum(wire.carried for wire in simulation.wires)
    return Sample(simulation.world.elapsed, sys.getallocatedblocks(), resident, frames)


def main() -> int:
    """Live and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--hours", type=float, default=24.0)
    hours = parser.parse_args().hours
    samples = []
    print(f"{'hour':>6}{'blocks':>10}{'resident MB':>13}{'frames':>12}{'processor s':>13}")
    with Simulation.simulated(plan=plan(hours)) as simulation:
        while simulation.world.elapsed < 3600 * hours:
            simulation.world.run(min(1800.0, 3600 * hours - simulation.world.elapsed))
            samples.append(sample(simulation))
            last = samples[-1]
            print(
                f"{last.at / 3600:>6.1f}{last.blocks:>10}{last.resident / 1e6:>13.1f}"
                f"{last.frames:>12}{time.process_time():>13.0f}",
                flush=True,
            )
    half = len(samples) // 2
    blocks = max(each.blocks for each in samples[half:]) - max(
        each.blocks for each in samples[:half]
    )
    resident = max(each.resident for each in samples[half:]) - max(
        each.resident for each in samples[:half]
    )
    print(f"grown in the second half: {blocks} blocks, {resident / 1e6:.1f} MB")
    return 0 if blocks <= BLOCKS and resident <= BYTES else 1


if __name__ == "__main__":
    sys.exit(main())
