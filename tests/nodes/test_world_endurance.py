"""What holds for a minute or a day of all nodes, in short."""

from __future__ import annotations

import gc
import sys
import threading

from benchmarks.five_nodes import CYCLES, TOLERANCE, measure

from swapcan.messages import B2V_ST1, V2B_CMD, B2V_Ucell
from swapcan.nodes.plan import plan_of
from swapcan.nodes.simulation import Simulation


def blocks_after(simulation: Simulation, seconds: float) -> int:
    """The memory blocks that are allocated after so much more time."""
    simulation.world.run(seconds)
    gc.collect()
    return sys.getallocatedblocks()


def test_memory_stays_as_it_is_while_time_passes() -> None:
    plan = plan_of("hv_on@1s, ask@2s, drive@3s, charge@5s")
    with Simulation.simulated(plan=plan) as simulation:
        first = blocks_after(simulation, 15.0)
        last = blocks_after(simulation, 30.0)
        frames = sum(wire.carried for wire in simulation.wires)
    assert frames > 45 * 190
    # One block for each frame would be 5,700; what nodes remember of payloads grows at first.
    assert last - first < 2000


def test_in_real_time_all_periods_are_kept_and_no_counter_is_missed() -> None:
    before = set(threading.enumerate())
    result = measure(3.0)
    assert set(threading.enumerate()) == before
    assert result.threads_left == 0
    assert result.faults == ()
    judged = {each.message for each in result.rhythms}
    assert {B2V_ST1, V2B_CMD, B2V_Ucell} <= judged
    for each in result.rhythms:
        assert each.cycles >= CYCLES
        assert abs(each.mean_error) <= TOLERANCE * each.period, each
    assert result.passed
