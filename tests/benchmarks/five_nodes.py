"""All five simulated nodes in real time on a virtual bus: how well they keep their periods.

    python tests/benchmarks/five_nodes.py [--seconds 60]

Prints for each message the error of its mean period and the 99th percentile of the error of single
periods, then the share of one processor, the counters missed and the threads left behind. Exits
with 1 where a mean period is off by more than 10 %, a counter is missed or a thread is left.
"""

from __future__ import annotations

import argparse
import math
import statistics
import sys
import threading
import time
from collections import defaultdict
from dataclasses import dataclass
from itertools import pairwise
from uuid import uuid4

import can

from swapcan import Fault
from swapcan._generated.protocol import PROTOCOL
from swapcan.nodes.plan import planned_step
from swapcan.nodes.simulation import Simulation
from swapcan.wire import Receiver
from typedcan.wire.message import Message

CYCLES = 5
"""Messages with fewer cycles are not judged."""

TOLERANCE = 0.1
"""Part of the period by which its mean may be off."""


@dataclass(frozen=True)
class Rhythm:
    """How a message kept its period: errors in seconds."""

    message: type[Message]
    period: float
    cycles: int
    mean_error: float
    p99_error: float


@dataclass(frozen=True)
class Result:
    """What came out; ``processor`` is the share of one processor."""

    rhythms: tuple[Rhythm, ...]
    frames: int
    processor: float
    faults: tuple[Fault, ...]
    threads_left: int

    @property
    def passed(self) -> bool:
        """Whether all periods were kept, no counter was missed and no thread was left."""
        kept = all(abs(each.mean_error) <= TOLERANCE * each.period for each in self.rhythms)
        return kept and not self.faults and not self.threads_left


def measure(seconds: float) -> Result:
    """Let all nodes live for so long."""
    channel = f"five-{uuid4()}"
    before = set(threading.enumerate())
    plan = [planned_step("hv_on@500ms"), planned_step("ask@1s"), planned_step("drive@2s")]
    with can.Bus(channel, "virtual", ignore_config=True) as listener:
        with Simulation(
            PROTOCOL.nodes, lambda: can.Bus(channel, "virtual", ignore_config=True), plan=plan
        ) as simulation:
            cpu, began = time.process_time(), time.perf_counter()
            with simulation.world:
                time.sleep(seconds)
                lived = time.time()
            processor = (time.process_time() - cpu) / (time.perf_counter() - began)
        frames = []
        while frame := listener.recv(0):
            if frame.timestamp <= lived:  # the last commands, off, come faster than periods
                frames.append(frame)
    left = len(set(threading.enumerate()) - before)
    rhythms, faults = judge(frames)
    return Result(rhythms, len(frames), processor, faults, left)


def judge(frames: list[can.Message]) -> tuple[tuple[Rhythm, ...], tuple[Fault, ...]]:
    """The rhythm of each message with a period, and what was wrong with frames."""
    receiver = Receiver()
    times: dict[tuple[type[Message], tuple[int, ...]], list[float]] = defaultdict(list)
    faults: list[Fault] = []
    for frame in frames:
        taken = receiver.take(frame)
        if isinstance(taken, Fault):
            faults.append(taken)
        elif taken:
            faults.extend(taken.faults)
            message = taken.message
            if type(message).PERIOD:
                part = (getattr(message, "csc_no", 0), getattr(message, "frame_no", 0))
                times[type(message), part].append(frame.timestamp)
    by_message: dict[type[Message], list[list[float]]] = defaultdict(list)
    for (kind, _), moments in times.items():
        if len(moments) > CYCLES:
            by_message[kind].append([later - sooner for sooner, later in pairwise(moments)])
    return tuple(rhythm(kind, gaps) for kind, gaps in by_message.items()), tuple(faults)


def rhythm(kind: type[Message], parts: list[list[float]]) -> Rhythm:
    """How a message kept its period, from the gaps between the frames of each of its parts."""
    period = kind.PERIOD or math.nan
    gaps = [gap for part in parts for gap in part]
    errors = sorted(abs(gap - period) for gap in gaps)
    p99 = errors[min(len(errors) - 1, math.ceil(0.99 * len(errors)) - 1)]
    return Rhythm(kind, period, min(map(len, parts)), statistics.fmean(gaps) - period, p99)


def main() -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0)
    result = measure(parser.parse_args().seconds)
    print(f"{'message':<15}{'period ms':>10}{'cycles':>8}{'mean error ms':>15}{'p99 error ms':>14}")
    for each in sorted(result.rhythms, key=lambda each: (each.period, each.message.NAME)):
        print(
            f"{each.message.NAME:<15}{1000 * each.period:>10.0f}{each.cycles:>8}"
            f"{1000 * each.mean_error:>15.3f}{1000 * each.p99_error:>14.3f}"
        )
    print(f"frames {result.frames}, processor {100 * result.processor:.1f} %")
    print(f"frames with faults {len(result.faults)}, threads left {result.threads_left}")
    return 0 if result.passed else 1


if __name__ == "__main__":
    sys.exit(main())
