"""Simulated nodes whose time a program lets pass end what acts on a signal, as a node does."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable
from contextlib import AbstractContextManager

import pytest
from node.programs import Program
from node.rough_bus import commands, is_off

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
    # A signal may come between the making of a frame and its sending: then a counter is left out.
    assert all(map(is_off, commands(run.heard)[-5:]))


def test_simulated_nodes_that_were_stopped_do_not_drive_on(program: Run) -> None:
    with program(DRIVE) as run:
        run.wait_until_on()
        run.process.send_signal(signal.SIGTSTP)
        _, status = os.waitpid(run.process.pid, os.WUNTRACED)
        assert os.WIFSTOPPED(status)
        sent = len(commands(run.hear()))
        assert all(map(is_off, commands(run.heard)[-5:]))
        run.process.send_signal(signal.SIGCONT)
        run.wait_for_line("gone on")
        run.wait_for_line("drives no more")
        assert run.end() == 0
    # When their block is left they end once more what they have commanded.
    assert all(map(is_off, commands(run.heard)[sent:]))


INTERRUPTED = DRIVE.replace(
    "with Simulation",
    """
from swapcan import decode

class Interrupted(can.BusABC):
    is_on = False
    def __init__(self):
        self.bus, self.channel_info = open_bus(), "interrupted"
        super().__init__(channel="interrupted")
    def _recv_internal(self, timeout):
        return self.bus.recv(timeout), True
    def send(self, msg, timeout=None):
        self.bus.send(msg, timeout)
        message = decode(msg.arbitration_id, bytes(msg.data))
        Interrupted.is_on |= getattr(message, "hv_on_off", 0) == 1
        if Interrupted.is_on and message.NAME == WITHIN and not ended.is_set():
            ended.set()
            time.sleep(0.06)  # now the next command is due too
            os.kill(os.getpid(), SIGNAL)
    def shutdown(self):
        super().shutdown()
        self.bus.shutdown()

ended = threading.Event()
with Simulation""",
).replace("lambda *_: open_bus()", "lambda *_: Interrupted()")
"""A signal comes in the middle of a frame."""


def interrupted(within: str, name: str) -> str:
    return f"WITHIN, SIGNAL = {within!r}, signal.{name}\n{INTERRUPTED}"


def test_a_signal_in_the_middle_of_a_frame_keeps_no_safe_code_back(program: Run) -> None:
    with program(interrupted("V2B_CMD", "SIGTERM")) as run:
        assert run.end() == -signal.SIGTERM
    assert len(commands(run.heard)) > 5
    assert all(map(is_off, commands(run.heard)[-5:]))


@pytest.mark.parametrize("within", ["V2B_CMD", "B2V_ST1"])
def test_what_ctrl_z_interrupts_in_the_middle_of_a_frame_is_not_driven_on(
    program: Run, within: str
) -> None:
    with program(interrupted(within, "SIGTSTP")) as run:
        _, status = os.waitpid(run.process.pid, os.WUNTRACED)
        assert os.WIFSTOPPED(status)
        sent = len(commands(run.hear()))
        assert all(map(is_off, commands(run.heard)[-5:]))
        run.process.send_signal(signal.SIGCONT)
        run.wait_for_line("gone on")
        run.wait_for_line("drives no more")
        assert run.end() == 0
    assert all(map(is_off, commands(run.heard)[sent:]))
