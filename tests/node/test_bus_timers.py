"""Cyclic messages on an interface that repeats frames by itself.

No such interface can be had on every machine: the bus here is a stand-in for one. It declares
timers of its own, as SocketCAN's bus does, and notes what it is asked for.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import can
import pytest
from can.broadcastmanager import (
    CyclicSendTaskABC,
    LimitedDurationCyclicSendTaskABC,
    ModifiableCyclicTaskABC,
)
from can.interfaces.virtual import VirtualBus
from node.bench import Recorder

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import B2V_ST1, B2V_ST2, B2V_ST3, B2V_Ucell
from swapcan.node import Node
from typedcan.node.bus_timers import has_timers
from typedcan.node.events import BusBack


class Task(LimitedDurationCyclicSendTaskABC):
    """A frame that the stand-in would repeat; its data cannot be changed."""

    def __init__(self, bus: TimerBus, messages: Sequence[can.Message], period: float) -> None:
        super().__init__(messages, period, None)
        self._bus = bus
        bus.note("begin", messages[0], period)

    def stop(self) -> None:
        self._bus.note("end", self.messages[0])


class ModifiableTask(ModifiableCyclicTaskABC, Task):
    """One whose data can be changed, as in SocketCAN."""

    def modify_data(self, messages: Sequence[can.Message] | can.Message) -> None:
        super().modify_data(messages)
        self._bus.note("change", self.messages[0])


class TimerBus(VirtualBus):
    """A stand-in for an interface with timers."""

    task: type[Task] = ModifiableTask
    noted: Recorder
    refuses = False

    def note(self, what: str, frame: can.Message, *more: Any) -> None:
        self.noted((what, frame.arbitration_id, frame.data.hex(), *more))

    def _send_periodic_internal(
        self, msgs: Any, period: float, *_: Any, **__: Any
    ) -> CyclicSendTaskABC:
        if self.refuses:
            raise can.CanOperationError("no timer left")
        return self.task(self, msgs, period)


@pytest.fixture
def timer_bus(near: can.BusABC) -> TimerBus:
    near.__class__ = TimerBus  # on the channel of the test, and closed after it
    assert isinstance(near, TimerBus)
    near.noted = Recorder()
    return near


ST2_0, ST2_80 = "00ffffffffffffff", "c8ffffffffffffff"
"""B2V_ST2 with an SOC of 0 and of 200 x 0.4 %, all else invalid."""


def test_interfaces_with_timers_are_told_from_those_without(timer_bus: TimerBus) -> None:
    assert has_timers(timer_bus)
    with can.Bus("test-timers", "virtual", ignore_config=True) as plain:
        assert not has_timers(plain)


def test_a_message_that_stays_the_same_is_handed_over_changed_and_taken_back(
    timer_bus: TimerBus, far: can.BusABC
) -> None:
    with Node(PROTOCOL, "BMU", timer_bus) as node:
        node.set(B2V_ST2(soc=0.0))
        timer_bus.noted.wait(1)
        node.set(B2V_ST2(soc=80.0))
    assert timer_bus.noted.seen == [
        ("begin", B2V_ST2.FRAME_ID, ST2_0, 0.1),
        ("change", B2V_ST2.FRAME_ID, ST2_80),
        ("end", B2V_ST2.FRAME_ID, ST2_80),
    ]
    assert far.recv(0) is None  # the stand-in sends nothing, and the node does not either


def test_what_needs_something_anew_each_time_is_sent_by_the_node(
    timer_bus: TimerBus, far: can.BusABC
) -> None:
    with Node(PROTOCOL, "BMU", timer_bus) as node:
        node.set(B2V_ST1())  # has a counter
        node.set(B2V_Ucell(frame_no=1), B2V_Ucell(frame_no=2))  # takes two frames
        node.supply(B2V_ST3, lambda: [B2V_ST3()])  # may differ each time
        wanted = {B2V_ST1.FRAME_ID, B2V_Ucell.FRAME_ID, B2V_ST3.FRAME_ID}
        while wanted and (frame := far.recv(1.0)):
            wanted.discard(frame.arbitration_id)
    assert wanted == set()
    assert timer_bus.noted.seen == []


def test_a_task_whose_data_cannot_be_changed_is_begun_anew(timer_bus: TimerBus) -> None:
    timer_bus.task = Task
    with Node(PROTOCOL, "BMU", timer_bus) as node:
        node.set(B2V_ST2(soc=0.0))
        timer_bus.noted.wait(1)
        node.set(B2V_ST2(soc=80.0))
    assert [(what, data) for what, _, data, *_ in timer_bus.noted.seen] == [
        ("begin", ST2_0),
        ("end", ST2_0),
        ("begin", ST2_80),
        ("end", ST2_80),
    ]


def test_what_is_cleared_postponed_or_given_another_period_is_taken_back(
    timer_bus: TimerBus,
) -> None:
    noted = timer_bus.noted
    with Node(PROTOCOL, "BMU", timer_bus) as node:
        node.set(B2V_ST2())
        noted.wait(1)
        node.set(B2V_ST2(), period=0.05)
        noted.wait(3)
        node.postpone(B2V_ST2, 0.01)
        noted.wait(5)
        node.clear(B2V_ST2)
        noted.wait(6)
    steps = [(what, *more) for what, _, _, *more in noted.seen]
    assert steps == [
        *(("begin", 0.1), ("end",), ("begin", 0.05), ("end",)),
        *(("begin", 0.05), ("end",)),
    ]


def test_an_interface_that_refuses_leaves_it_to_the_node(
    timer_bus: TimerBus, far: can.BusABC
) -> None:
    timer_bus.refuses = True
    with Node(PROTOCOL, "BMU", timer_bus) as node:
        node.set(B2V_ST2(), period=0.02)
        assert [far.recv(1.0) is not None for _ in range(3)] == [True] * 3


def test_tasks_of_others_on_the_bus_are_left_alone(timer_bus: TimerBus) -> None:
    theirs = timer_bus.send_periodic(can.Message(arbitration_id=0x123), 0.1)
    with Node(PROTOCOL, "BMU", timer_bus) as node:
        node.set(B2V_ST2())
        timer_bus.noted.wait(2)
    ended = [identifier for what, identifier, *_ in timer_bus.noted.seen if what == "end"]
    assert ended == [B2V_ST2.FRAME_ID]
    theirs.stop()


def test_a_bus_that_was_opened_anew_is_handed_the_message_again(
    timer_bus: TimerBus, open_bus: Callable[..., can.BusABC]
) -> None:
    back, noted = Recorder(), timer_bus.noted

    def reopen() -> can.BusABC:
        bus = open_bus()
        bus.__class__ = TimerBus
        assert isinstance(bus, TimerBus)
        bus.noted = noted
        return bus

    with Node(PROTOCOL, "BMU", timer_bus, reopen=reopen) as node:
        node.on(BusBack, back)
        node.set(B2V_ST2())
        noted.wait(1)
        timer_bus.shutdown()
        back.wait()
        noted.wait_until(lambda _: sum(what == "begin" for what, *_ in noted.seen) == 2)
