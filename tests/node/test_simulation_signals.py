"""Simulated nodes whose time a program lets pass end what acts on a signal, as a node does."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable
from contextlib import AbstractContextManager

import pytest
from node.programs import Program
from node.rough_bus import trailing_offs

if sys.platform == "win32":
    pytest.skip("Windows has no signals for others than oneself", allow_module_level=True)

Run = Callable[[str], AbstractContextManager[Program]]

DRIVE = """
from swapcan.simulate import Simulation, plan_of

def open_bus():
    return can.Bus(ignore_config=True, **json.loads(sys.argv[1]))

with Simulation(["VCU", "BMU"], lambda *_: open_bus(), plan=plan_of("hv_on@0s")) as simulation:
    try:
        simulation.world.run(60)
    except SendingError:
        print("gone on", flush=True)
        try:
            simulation.world.run(1)
        except SendingError:
            print("drives no more", flush=True)
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_what_simulated_nodes_command(program: Run, number: int) -> None:
    with program(DRIVE) as run:
        run.wait_until_on()
        assert run.end(number) == -number
    assert len(trailing_offs(run.heard)) >= 5


def test_simulated_nodes_that_were_stopped_do_not_drive_on(program: Run) -> None:
    with program(DRIVE) as run:
        run.wait_until_on()
        run.process.send_signal(signal.SIGTSTP)
        _, status = os.waitpid(run.process.pid, os.WUNTRACED)
        assert os.WIFSTOPPED(status)
        offs = len(trailing_offs(run.hear()))
        assert offs >= 5
        run.process.send_signal(signal.SIGCONT)
        run.wait_for_line("gone on")
        run.wait_for_line("drives no more")
        assert run.end() == 0
    assert len(trailing_offs(run.heard)) == offs
