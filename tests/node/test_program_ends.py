"""A program that ends without stopping its node ends what acts, as processes of their own."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager

import pytest
from node.programs import Program
from node.rough_bus import is_off, is_on, trailing_offs

Run = Callable[[str], AbstractContextManager[Program]]

DRIVES = """
node = Node(PROTOCOL, "VCU", bus)
node.start()
node.set(ON)
while not node.acting:
    time.sleep(0.01)
"""

ENDS = {
    "the end of main": ("", 0),
    "sys.exit": ("sys.exit(5)", 5),
    "an exception": ("raise KeyError('uncaught')", 1),
    "sys.exit in a function with all that is there": (
        "def main():\n    other, it = bus, node\n    sys.exit(6)\nmain()",
        6,
    ),
    "a program that forgets its node": ("del node, bus", 0),
}


@pytest.mark.parametrize(("end", "status"), ENDS.values(), ids=ENDS)
def test_however_a_program_ends_off_is_its_last_word(program: Run, end: str, status: int) -> None:
    with program(DRIVES + end) as run:
        run.wait_until_on()
        assert run.end() == status
        assert "TAKE IT FOR LIVE" not in run.errors()
    assert len(trailing_offs(run.heard)) >= 5


def test_a_thread_that_outlives_main_drives_on_until_it_ends(program: Run) -> None:
    text = """
def live():
    print("lives", flush=True)
    sys.stdin.read()
threading.Thread(target=live).start()
"""
    with program(DRIVES + text) as run:
        run.wait_for_line("lives")
        run.wait_until_on()
        assert not any(map(is_off, run.hear()))
        run.end_its_input()
        assert run.end() == 0
    assert len(trailing_offs(run.heard)) >= 5


def test_a_bus_that_was_closed_before_the_program_ends_is_said_to_be_live(program: Run) -> None:
    with program(DRIVES + "bus.shutdown()") as run:
        run.wait_until_on()
        assert run.end() == 0
        errors = run.errors()
    assert "VCU: " in errors
    assert "V2B_CMD" in errors
    assert "TAKE IT FOR LIVE" in errors
    assert all(map(is_on, run.heard))


def test_an_interrupted_program_that_catches_it_and_ends_leaves_nothing_on(program: Run) -> None:
    text = """
import _thread
shown = []
def off(frame, timeout=None, send=bus.send):
    send(frame, timeout)
    if stopping and not shown:
        shown.append(frame)
        _thread.interrupt_main()  # in the midst of the safe codes
bus.send = off
stopping = False
try:
    stopping = True
    node.stop()
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""
    with program(DRIVES + text) as run:
        run.wait_for_line("interrupted")
        assert run.end() == 0
    assert len(trailing_offs(run.heard)) >= 5
