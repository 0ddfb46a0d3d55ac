"""Signals within this process: whose are taken over and when, and what is given back.

Windows' Ctrl-Break is tested by calling what would be its handler, and untested on Windows.
"""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable
from typing import Any

import can
import pytest
from node.bench import Recorder
from node.rough_bus import (
    Hang,
    RoughBus,
    frames_until,
    is_off,
    is_on,
    nothing,
    raising,
    rest,
    trailing_offs,
)

from swapcan import SendingError
from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import V2B_CMD, HvCommand
from swapcan.node import Node
from typedcan.node.schedule import Schedule
from typedcan.shell import process_signals
from typedcan.shell.process_signals import LastWords

pytestmark = [
    pytest.mark.skipif(
        not hasattr(signal, "SIGUSR1"), reason="Windows has no signals that nobody listens to"
    ),
    pytest.mark.usefixtures("untouched_signals"),
]

ON = V2B_CMD(hv_on_off=HvCommand.HV_ON)

TAKEN = ("SIGTERM", "SIGHUP", "SIGQUIT", "SIGUSR1", "SIGUSR2", "SIGALRM", "SIGTSTP", "SIGTTOU")
LEFT = ("SIGINT", "SIGCHLD", "SIGCONT", "SIGWINCH", "SIGURG", "SIGSEGV", "SIGFPE", "SIGPIPE")


def handlers(names: tuple[str, ...]) -> list[Any]:
    return [signal.getsignal(getattr(signal, name)) for name in names if hasattr(signal, name)]


def test_what_nobody_listens_to_is_taken_over_while_a_node_lives_that_can_act(
    near: can.BusABC,
) -> None:
    left = handlers(LEFT)
    with Node(PROTOCOL, "VCU", near), Node(PROTOCOL, "BMU", near):
        assert all(callable(handler) for handler in handlers(TAKEN))
        assert handlers(LEFT) == left
    assert handlers(TAKEN) == [signal.SIG_DFL] * len(handlers(TAKEN))


@pytest.mark.parametrize(("name", "options"), [("TMS", {}), ("VCU", {"leave": "silent"})])
def test_a_node_that_has_nothing_to_say_in_the_end_takes_nothing_over(
    near: can.BusABC, name: str, options: dict[str, Any]
) -> None:
    with Node(PROTOCOL, name, near, **options):
        assert handlers(TAKEN) == [signal.SIG_DFL] * len(handlers(TAKEN))


def test_a_node_that_is_started_in_another_thread_takes_nothing_over(near: can.BusABC) -> None:
    node = Node(PROTOCOL, "VCU", near)
    thread = threading.Thread(target=node.start)
    thread.start()
    thread.join()
    assert handlers(TAKEN) == [signal.SIG_DFL] * len(handlers(TAKEN))
    with Node(PROTOCOL, "BMU", near):  # whose handlers are for both
        assert callable(signal.getsignal(signal.SIGTERM))
    assert callable(signal.getsignal(signal.SIGTERM))
    node.stop()
    assert handlers(TAKEN) == [signal.SIG_DFL] * len(handlers(TAKEN))


def test_what_a_program_sets_before_or_meanwhile_stays(near: can.BusABC) -> None:
    signal.signal(signal.SIGTERM, nothing)
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    with Node(PROTOCOL, "VCU", near):
        assert signal.getsignal(signal.SIGTERM) is nothing
        assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
        signal.signal(signal.SIGUSR1, nothing)
    assert signal.getsignal(signal.SIGTERM) is nothing
    assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    assert signal.getsignal(signal.SIGUSR1) is nothing
    assert signal.getsignal(signal.SIGUSR2) is signal.SIG_DFL


def test_what_a_program_gives_up_again_is_taken_over_by_the_next_node(near: can.BusABC) -> None:
    with Node(PROTOCOL, "VCU", near):
        signal.signal(signal.SIGUSR1, signal.SIG_DFL)
        with Node(PROTOCOL, "BMU", near):
            assert callable(signal.getsignal(signal.SIGUSR1))


def test_a_signal_in_the_middle_of_a_transmission_lets_it_not_go_on(
    rough: RoughBus, far: can.BusABC, survived: Recorder
) -> None:
    def interrupt(_: can.Message) -> None:
        if threading.current_thread() is threading.main_thread():
            rough.before_send = nothing
            signal.raise_signal(signal.SIGUSR1)

    with Node(PROTOCOL, "VCU", rough) as node:
        node.send(ON)
        rough.before_send = interrupt
        with pytest.raises(SendingError, match="stopped by a signal"):
            node.send(ON)
        heard = rest(far)
        with pytest.raises(SendingError, match="stopped by a signal"):
            node.set(ON)
    assert survived.seen == [signal.SIGUSR1]
    assert is_on(heard[0])
    assert len(trailing_offs(heard)) == len(heard) - 1 >= 5
    assert all(map(is_off, rest(far)))  # what it was in the middle of ends safe once more


def test_a_signal_in_the_middle_of_a_change_ends_what_acts(
    near: can.BusABC, far: can.BusABC, survived: Recorder, monkeypatch: pytest.MonkeyPatch
) -> None:
    with Node(PROTOCOL, "VCU", near) as node:
        node.set(ON)
        heard = frames_until(far, is_on)
        add = Schedule.add

        def add_and_interrupt(schedule: Schedule, *arguments: Any) -> None:
            add(schedule, *arguments)
            # The main thread holds what the one that sends would need.
            monkeypatch.setattr(Schedule, "add", add)
            signal.raise_signal(signal.SIGTERM)

        monkeypatch.setattr(Schedule, "add", add_and_interrupt)
        node.set(ON)
        heard += rest(far)
        assert len(trailing_offs(heard)) >= 5
        assert survived.seen == [signal.SIGTERM]
    assert is_off((heard + rest(far))[-1])


def test_a_node_that_a_signal_has_ended_can_be_started_again(
    near: can.BusABC, far: can.BusABC, survived: Recorder
) -> None:
    node = Node(PROTOCOL, "VCU", near)
    for _ in range(2):
        with node:
            node.set(ON)
            heard = frames_until(far, is_on)
            signal.raise_signal(signal.SIGTERM)
            assert len(trailing_offs(heard + rest(far))) >= 5
            assert node.acting == ()
            with pytest.raises(SendingError, match="VCU has been stopped by a signal"):
                node.send(ON)
        assert rest(far) == []
    assert len(survived.seen) == 2


class Speaker:
    """Says its last words as a test wants it to."""

    def __init__(self, act: Callable[[], object] = nothing) -> None:
        self.spoke = Recorder()
        self.went_on = Recorder()
        self._act = act

    def speak_last(self) -> None:
        self.spoke(threading.current_thread().name)
        self._act()

    def go_on(self) -> None:
        self.went_on(None)


def test_one_who_hangs_or_fails_keeps_nobody_from_speaking(
    survived: Recorder, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(process_signals, "_PATIENCE", 0.2)
    monkeypatch.setattr(threading, "excepthook", failed := Recorder())
    hang = Hang()
    words = LastWords()
    speakers = [Speaker(hang), Speaker(raising(KeyError)), Speaker()]
    for speaker in speakers:
        words.add(speaker)
    signal.raise_signal(signal.SIGTERM)
    assert survived.seen == [signal.SIGTERM]
    assert [len(speaker.spoke.seen) for speaker in speakers] == [1, 1, 1]
    assert [len(speaker.went_on.seen) for speaker in speakers] == [1, 1, 1]
    assert [failure.exc_type for failure in failed.seen] == [KeyError]
    hang.release()
    for speaker in speakers:
        words.discard(speaker)
    for thread in threading.enumerate():
        if thread.name == "typedcan-last-words":
            thread.join(30.0)


def test_where_no_thread_can_be_started_the_main_thread_speaks(
    survived: Recorder, monkeypatch: pytest.MonkeyPatch
) -> None:
    words, speaker = LastWords(), Speaker()
    words.add(speaker)
    monkeypatch.setattr(threading.Thread, "start", raising(RuntimeError))
    signal.raise_signal(signal.SIGTERM)
    words.discard(speaker)
    assert speaker.spoke.seen == [threading.main_thread().name]


@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # of fork beside threads, since 3.12
def test_a_copy_of_the_process_has_nothing_to_say(near: can.BusABC) -> None:
    with Node(PROTOCOL, "VCU", near):
        pid = os.fork()
        if pid == 0:
            os._exit(sum(handler is not signal.SIG_DFL for handler in handlers(TAKEN)))
        assert os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == 0
        assert all(callable(handler) for handler in handlers(TAKEN))


def test_break_on_windows_ends_what_a_node_has_commanded(
    near: can.BusABC, far: can.BusABC, as_on_windows: int, survived: Recorder
) -> None:
    with Node(PROTOCOL, "VCU", near) as node:
        node.set(ON)
        heard = frames_until(far, is_on)
        handler = signal.getsignal(signal.SIGTERM)
        assert callable(handler)
        handler(as_on_windows, None)
        assert len(trailing_offs(heard + rest(far))) >= 5
    assert survived.seen == [as_on_windows]
