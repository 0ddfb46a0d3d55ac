"""What time alone changes is told in time, whatever the thread that receives does."""

from __future__ import annotations

import threading
import time

import can
import pytest
from node.bench import Recorder
from node.rough_bus import Hang, RoughBus, frames_until, is_off, is_on, nothing, rest

from swapcan import RequestTimeoutError
from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import B2V_ST1, B2V_ST2, V2B_CMD, HvCommand
from swapcan.node import Node, SendFailed
from typedcan.supervise import NotSeen, State, StateChanged

ON = V2B_CMD(hv_on_off=HvCommand.HV_ON)
OFF = V2B_CMD(
    hv_on_off=HvCommand.HV_OFF,
    hv_acc_on_off=2,
    heat_on_off=2,
)


def st2() -> can.Message:
    return can.Message(arbitration_id=B2V_ST2.FRAME_ID, data=bytes(8))


class Program:
    """A program that switches off where the pack falls silent."""

    def __init__(self, node: Node) -> None:
        self.changed = Recorder()
        self.alive = threading.Event()
        self._node = node
        node.on(StateChanged, self.react)

    def react(self, event: StateChanged) -> None:
        if event.message is B2V_ST2 and event.new is State.LOST:
            self._node.set(OFF)
        if event.new is State.ALIVE:
            self.alive.set()
        self.changed(event)

    def is_lost(self, event: StateChanged) -> bool:
        return event.message is B2V_ST2 and event.new is State.LOST


@pytest.fixture
def vcu(rough: RoughBus) -> Node:
    return Node(PROTOCOL, "VCU", rough, expect=[B2V_ST2, B2V_ST1])


def assert_off_in_time(vcu: Node, far: can.BusABC, program: Program) -> None:
    heard = frames_until(far, is_on)
    event = program.changed.wait_until(program.is_lost, timeout=30.0)
    # Five periods of 100 ms, and as long again until a receiver counts as hanging.
    assert 0.5 <= event.silence < 0.9
    heard += frames_until(far, is_off)
    late = heard[-1].timestamp - next(each.timestamp for each in heard if is_on(each))
    assert late < 1.5
    while rest(far):  # it stays off
        pass
    frames_until(far, is_off)
    assert not any(map(is_on, rest(far)))


def test_a_bus_that_does_not_come_back_from_receiving(
    rough: RoughBus, far: can.BusABC, vcu: Node, hang: Hang
) -> None:
    program = Program(vcu)
    vcu.start()
    vcu.set(ON)
    far.send(st2())
    assert program.alive.wait(30.0)
    rough.before_recv = hang
    assert_off_in_time(vcu, far, program)
    start = time.perf_counter()
    vcu.stop()
    assert time.perf_counter() - start < 4.5


def test_a_callback_that_does_not_come_back(far: can.BusABC, vcu: Node, hang: Hang) -> None:
    program = Program(vcu)
    vcu.on(B2V_ST2, hang)
    vcu.start()
    vcu.set(ON)
    far.send(st2())
    assert_off_in_time(vcu, far, program)
    hang.release()
    vcu.stop()


def test_callbacks_of_states_that_do_not_come_back_either_hold_no_command_up(
    far: can.BusABC, vcu: Node, hang: Hang
) -> None:
    program = Program(vcu)
    vcu.on(B2V_ST2, hang)
    vcu.on(StateChanged, hang)
    vcu.start()
    vcu.set(ON)
    far.send(st2())
    program.changed.wait_until(lambda event: event.new is State.LOST, timeout=30.0)
    # Both threads that call back hang now; the one that sends sends.
    rest(far)
    assert all(far.recv(30.0) for _ in range(5))
    hang.release()
    vcu.stop()


@pytest.mark.parametrize("behind", ["the bus", "a callback"])
def test_the_rest_that_time_changes_is_told_too(
    rough: RoughBus, far: can.BusABC, vcu: Node, hang: Hang, behind: str
) -> None:
    missed, failed = Recorder(), Recorder()
    vcu.on(NotSeen, missed)
    vcu.on(SendFailed, failed)
    if behind == "a callback":
        vcu.on(B2V_ST2, hang)
    else:
        rough.before_recv = hang
    vcu.start()
    far.send(st2())
    with pytest.raises(RequestTimeoutError):
        vcu.request_battery_info(timeout=0.2).result(30.0)

    def fail(_: can.Message) -> None:
        raise KeyError("type")

    rough.before_send = fail
    vcu.set(OFF)
    assert "KeyError" in failed.wait(timeout=30.0)[0].error
    missed.wait_until(lambda event: event.message is B2V_ST1, timeout=30.0)
    hang.release()
    vcu.stop()


def test_a_bus_that_does_not_wait_for_frames_costs_little_and_time_goes_on(
    rough: RoughBus, far: can.BusABC, vcu: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    receive = RoughBus.recv
    monkeypatch.setattr(RoughBus, "recv", lambda self, timeout=None: receive(self, 0))
    program = Program(vcu)
    with vcu:
        vcu.set(ON)
        far.send(st2())
        assert program.alive.wait(30.0)
        before, since = time.thread_time(), time.process_time()
        event = program.changed.wait_until(program.is_lost, timeout=30.0)
        busy = (time.process_time() - since) - (time.thread_time() - before)
        assert event.silence == pytest.approx(0.5, abs=0.2)
        assert busy < 0.35  # of half a second
        frames_until(far, is_off)


def test_nobody_stands_in_for_one_who_comes_round(
    far: can.BusABC, vcu: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    started: list[str] = []
    start = threading.Thread.start

    def note_and_start(thread: threading.Thread) -> None:
        started.append(thread.name)
        start(thread)

    monkeypatch.setattr(threading.Thread, "start", note_and_start)
    with vcu:
        vcu.set(ON)
        assert all(far.recv(30.0) for _ in range(5))
    assert started == ["typedcan-VCU-send", "typedcan-VCU-receive"]


def test_who_receives_again_takes_over_again(rough: RoughBus, far: can.BusABC, vcu: Node) -> None:
    entered, goes_on = threading.Event(), threading.Event()

    def hang_once(*_: object) -> None:
        rough.before_recv = nothing
        entered.set()
        goes_on.wait(30.0)

    changed, heard = Recorder(), Recorder()
    vcu.on(StateChanged, changed)
    vcu.on(B2V_ST2, lambda received: heard(threading.current_thread().name))
    with vcu:
        far.send(st2())
        heard.wait(timeout=30.0)
        rough.before_recv = hang_once
        assert entered.wait(30.0)
        changed.wait_until(lambda event: event.new is State.LOST, timeout=30.0)
        assert "typedcan-VCU-stand-in" in {thread.name for thread in threading.enumerate()}
        goes_on.set()
        far.send(st2())
        assert heard.wait(2, timeout=30.0) == ["typedcan-VCU-receive"] * 2
        stand_in = [each for each in threading.enumerate() if each.name.endswith("stand-in")]
        for thread in stand_in:
            thread.join(30.0)
            assert not thread.is_alive()
