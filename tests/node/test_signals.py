"""Signals end what acts first, as real ones for real processes; then they do what they do.

SIGKILL and SIGSTOP cannot be caught, and nothing is promised of them.
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable
from contextlib import AbstractContextManager

import pytest
from node.programs import Program
from node.rough_bus import is_off, is_on, trailing_offs

if sys.platform == "win32":
    pytest.skip("Windows has no signals for others than oneself", allow_module_level=True)

Run = Callable[[str], AbstractContextManager[Program]]

DRIVE = """
with Node(PROTOCOL, "VCU", bus) as node:
    node.set(ON)
    wait()
"""

SIGNALS = {
    "SIGINT": signal.SIGINT,
    "SIGTERM": signal.SIGTERM,
    "SIGHUP": signal.SIGHUP,
    "SIGQUIT": signal.SIGQUIT,
    "SIGUSR1": signal.SIGUSR1,
    "SIGUSR2": signal.SIGUSR2,
    "SIGALRM": signal.SIGALRM,
    "SIGABRT": signal.SIGABRT,
    "a real-time signal": getattr(signal, "SIGRTMIN", signal.SIGTERM) + 5,
}


@pytest.mark.parametrize("number", SIGNALS.values(), ids=SIGNALS)
def test_a_signal_ends_what_acts_and_then_the_process(program: Run, number: int) -> None:
    with program(DRIVE) as run:
        run.wait_until_on()
        assert run.end(number) == -number
    assert len(trailing_offs(run.heard)) >= 5


@pytest.mark.parametrize("name", ["SIGINT", "SIGPIPE"])
def test_a_program_may_have_undone_what_python_does_of_a_signal(program: Run, name: str) -> None:
    number = getattr(signal, name)
    with program(f"signal.signal(signal.{name}, signal.SIG_DFL)\n{DRIVE}") as run:
        run.wait_until_on()
        assert run.end(number) == -number
    assert len(trailing_offs(run.heard)) >= 5


def test_a_signal_that_is_ignored_stays_ignored(program: Run) -> None:
    ignore = "signal.signal(signal.SIGHUP, signal.SIG_IGN)\n"
    with program(ignore + DRIVE) as run:
        run.wait_until_on()
        run.process.send_signal(signal.SIGHUP)
        run.wait_until_on()
        assert not any(map(is_off, run.hear()))
        assert run.end(signal.SIGTERM) == -signal.SIGTERM


@pytest.mark.parametrize("number", [signal.SIGTSTP, signal.SIGTTIN, signal.SIGTTOU])
def test_what_stops_the_process_ends_what_acts_and_it_does_not_drive_on(
    program: Run, number: int
) -> None:
    text = """
with Node(PROTOCOL, "VCU", bus) as node:
    node.set(ON)
    gone_on.wait()
    for act in (node.set, node.send, node.provide, lambda each: node.supply(V2B_CMD, list)):
        try:
            act(ON)
        except SendingError as error:
            print(error, flush=True)
    time.sleep(0.3)
print("left", flush=True)
"""
    prepare = """
gone_on = threading.Event()
signal.signal(signal.SIGCONT, lambda *_: gone_on.set())
"""
    with program(prepare + text) as run:
        run.wait_until_on()
        run.process.send_signal(number)
        _, status = os.waitpid(run.process.pid, os.WUNTRACED)
        assert os.WIFSTOPPED(status)
        assert os.WSTOPSIG(status) == number
        offs = len(trailing_offs(run.hear()))
        assert offs >= 5
        run.process.send_signal(signal.SIGCONT)
        for _ in range(4):
            run.wait_for_line("VCU has been stopped by a signal, it sends nothing more")
        run.wait_for_line("left")
        assert run.end() == 0
    assert len(trailing_offs(run.heard)) == offs


def test_a_program_that_handles_a_signal_itself_keeps_its_handler(program: Run) -> None:
    text = """
def mine(number, frame):
    print("mine", flush=True)
    if node.acting and hits:
        sys.exit(7)
    hits.append(number)
hits = []
signal.signal(signal.SIGTERM, mine)
"""
    with program(text + DRIVE) as run:
        run.wait_until_on()
        run.process.send_signal(signal.SIGTERM)
        run.wait_for_line("mine")
        run.wait_until_on()  # it drives on, as the program wants it
        assert run.end(signal.SIGTERM) == 7
    assert len(trailing_offs(run.heard)) >= 5


def test_a_handler_that_is_not_written_in_python_is_kept_too(program: Run) -> None:
    text = "import faulthandler\nfaulthandler.register(signal.SIGUSR1)\n"
    with program(text + DRIVE) as run:
        run.wait_until_on()
        run.process.send_signal(signal.SIGUSR1)
        assert run.process.stderr
        assert "most recent call first" in run.process.stderr.readline()
        run.wait_until_on()
        assert not any(map(is_off, run.hear()))
        assert run.end(signal.SIGTERM) == -signal.SIGTERM
    assert len(trailing_offs(run.heard)) >= 5


BUSY = {
    "set": "while True: node.set(ON)",
    "send": "while not time.sleep(0.0005): node.send(ON)",  # as much as a socket can hold
    "start": "while True: node.stop(); node.start(); node.send(ON)",
}


@pytest.mark.parametrize("what", BUSY.values(), ids=BUSY)
def test_wherever_the_main_thread_is_the_signal_ends_what_acts(program: Run, what: str) -> None:
    text = f"""
with Node(PROTOCOL, "VCU", bus) as node:
    node.set(ON)
    {what}
"""
    with program(text) as run:
        run.wait_until_on()
        assert run.end(signal.SIGTERM) == -signal.SIGTERM
    assert run.heard
    assert is_off(run.heard[-1])


def test_a_bus_that_hangs_does_not_keep_the_process_alive(program: Run) -> None:
    text = """
send, count = bus.send, 0
def hang(frame, timeout=None):
    global count
    count += 1
    if count == 3:
        print("hangs", flush=True)
        wait()
    send(frame, timeout)
bus.send = hang
"""
    with program(text + DRIVE) as run:
        run.wait_for_line("hangs")
        assert run.end(signal.SIGTERM) == -signal.SIGTERM
    assert len(trailing_offs(run.heard)) >= 5


def test_a_driver_with_one_lock_that_hangs_does_not_keep_the_process_alive(program: Run) -> None:
    text = """
lock, send, count = threading.Lock(), bus.send, 0
def hang(frame, timeout=None):
    global count
    with lock:
        count += 1
        if count == 3:
            print("hangs", flush=True)
            wait()
        send(frame, timeout)
bus.send = hang
"""
    with program(text + DRIVE) as run:
        run.wait_for_line("hangs")
        assert run.end(signal.SIGTERM) == -signal.SIGTERM
    assert all(map(is_on, run.heard))  # nobody could have sent anything more


def test_two_nodes_end_what_each_has_commanded(program: Run) -> None:
    text = """
from swapcan.messages import B2C_Charger, ChargeControl
other = can.Bus(ignore_config=True, **json.loads(sys.argv[1]))
with Node(PROTOCOL, "BMU", other) as bmu:
    bmu.set(B2C_Charger(charge_control=ChargeControl.START_TO_CHARGE), period=0.05)
"""
    with program(text + DRIVE.replace("\n", "\n    ")) as run:
        run.wait_until_on()
        while not any(frame.arbitration_id == 0x180156F3 for frame in run.hear()):
            pass
        assert run.end(signal.SIGTERM) == -signal.SIGTERM
    assert len(trailing_offs(run.heard)) >= 5
    # The control is the fifth byte of B2C_Charger; 1 is to stop (table 18 row 3).
    chargers = [frame for frame in run.heard if frame.arbitration_id == 0x180156F3]
    assert [frame.data[4] & 0b11 for frame in chargers[-5:]] == [1] * 5


def test_a_signal_for_a_copy_of_the_process_ends_nothing_of_its_parent(program: Run) -> None:
    text = """
with Node(PROTOCOL, "VCU", bus) as node:
    node.set(ON)
    reads, writes = os.pipe()
    copy = os.fork()
    if copy == 0:
        os.write(writes, b"here")
        wait()
    os.read(reads, 4)
    os.kill(copy, signal.SIGTERM)
    print(os.waitstatus_to_exitcode(os.waitpid(copy, 0)[1]), flush=True)
    wait()
"""
    with program(text) as run:
        run.wait_for_line(str(-signal.SIGTERM))
        run.wait_until_on()
        assert not any(map(is_off, run.hear()))
        assert run.end(signal.SIGTERM) == -signal.SIGTERM
    assert len(trailing_offs(run.heard)) >= 5


def test_a_world_in_real_time_ends_what_its_participants_command(program: Run) -> None:
    text = """
from swapcan.simulate import Bmu, Vcu, World
vcu = Vcu(bus)
pack = can.Bus(ignore_config=True, **json.loads(sys.argv[1]))
with World(vcu, Bmu(pack)):
    vcu.hv_on()
    wait()
"""
    with program(text) as run:
        run.wait_until_on()
        assert run.end(signal.SIGTERM) == -signal.SIGTERM
    assert len(trailing_offs(run.heard)) >= 5
