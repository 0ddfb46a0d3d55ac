"""What commands make of signals: they interrupt nothing, and are acted on where it is time to.

Windows' Ctrl-Break is tested by calling what would be its handler, and untested on Windows.
"""

from __future__ import annotations

import signal
import threading

import pytest
from node.bench import Recorder
from node.rough_bus import nothing, raising

from typedcan.shell.process_signals import Interrupts

pytestmark = [
    pytest.mark.skipif(
        not hasattr(signal, "SIGUSR1"), reason="Windows has no signals that nobody listens to"
    ),
    pytest.mark.usefixtures("untouched_signals"),
]

NAMES = [
    *("SIGTERM", "SIGHUP", "SIGQUIT", "SIGUSR1", "SIGUSR2", "SIGALRM", "SIGVTALRM", "SIGPROF"),
    *("SIGIO", "SIGXCPU", "SIGPWR", "SIGRTMIN", "SIGRTMAX", "SIGBREAK"),
]


def handlers() -> dict[int, object]:
    """What each signal of this process is handled by."""
    return {number: signal.getsignal(number) for number in signal.valid_signals()}


def status_of(interrupts: Interrupts) -> object:
    """With what it leaves the program; None where it does not."""
    with pytest.raises(SystemExit) as ended:
        interrupts.go_on()
    return ended.value.code


def test_without_a_signal_it_is_not_over() -> None:
    with Interrupts() as interrupts:
        interrupts.stop_if_asked()
        interrupts.go_on()
    assert not interrupts.is_over
    assert interrupts.status is None


def test_ctrl_c_ends_what_goes_on_and_a_second_one_the_program() -> None:
    with Interrupts() as interrupts:
        signal.raise_signal(signal.SIGINT)
        assert interrupts.is_over
        interrupts.go_on()
        signal.raise_signal(signal.SIGINT)
        with pytest.raises(KeyboardInterrupt):
            interrupts.go_on()
    assert interrupts.status == 130


@pytest.mark.parametrize("name", [name for name in NAMES if hasattr(signal, name)])
def test_other_signals_end_the_program_with_their_number(name: str) -> None:
    number = getattr(signal, name)
    before = handlers()
    with Interrupts() as interrupts:
        signal.raise_signal(number)
        signal.raise_signal(signal.SIGINT)
        assert interrupts.is_over
        assert status_of(interrupts) == 128 + number
    assert interrupts.status == 128 + number
    assert handlers() == before
    assert before[number] is signal.SIG_DFL


def test_what_ends_a_process_goes_before_ctrl_c_and_that_before_ctrl_z() -> None:
    with Interrupts() as interrupts:
        signal.raise_signal(signal.SIGTSTP)
        assert interrupts.is_over
        signal.raise_signal(signal.SIGINT)
        assert interrupts.status == 128 + signal.SIGINT
        signal.raise_signal(signal.SIGTERM)
        assert interrupts.status == 128 + signal.SIGTERM


def test_signals_that_end_no_process_are_left_alone() -> None:
    with Interrupts() as interrupts:
        for name in ("SIGCHLD", "SIGCONT", "SIGWINCH", "SIGURG"):
            signal.raise_signal(getattr(signal, name))
    assert not interrupts.is_over


def test_where_the_program_hangs_a_signal_breaks_into_that() -> None:
    with Interrupts() as interrupts:
        interrupts.hangs = lambda: True
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        with pytest.raises(SystemExit, match=str(128 + signal.SIGTERM)):
            signal.raise_signal(signal.SIGTERM)
        assert interrupts.is_over


def test_ctrl_z_stops_the_process_where_it_is_time_to_and_it_stays_over(
    survived: Recorder,
) -> None:
    with Interrupts() as interrupts:
        signal.raise_signal(signal.SIGTSTP)
        assert survived.seen == []
        assert interrupts.is_over
        assert interrupts.status is None
        interrupts.stop_if_asked()
        assert survived.seen == [signal.SIGTSTP]
        interrupts.stop_if_asked()
        assert survived.seen == [signal.SIGTSTP]
        assert interrupts.is_over
        interrupts.go_on()
    assert interrupts.status == 128 + signal.SIGTSTP


@pytest.mark.parametrize("name", ["SIGTTIN", "SIGTTOU"])
def test_a_terminal_that_is_anothers_stops_it_once_what_acts_was_ended(
    survived: Recorder, name: str
) -> None:
    number = getattr(signal, name)
    done: list[int] = []
    with Interrupts() as interrupts:
        interrupts.at_once = lambda: done.append(len(survived.seen))
        signal.raise_signal(number)
        assert done == [0]
        assert survived.seen == [number]
        assert interrupts.is_over


def test_what_a_command_does_at_once_may_fail_and_the_signal_stops_it_all_the_same(
    survived: Recorder, caplog: pytest.LogCaptureFixture
) -> None:
    with Interrupts() as interrupts:
        interrupts.at_once = raising(KeyError)
        signal.raise_signal(signal.SIGTTOU)
        assert interrupts.is_over
        assert interrupts.status == 128 + signal.SIGTTOU
    assert survived.seen == [signal.SIGTTOU]
    assert len(caplog.records) == 1


def test_what_is_ignored_stays_ignored_and_what_others_handle_comes_back() -> None:
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, nothing)
    signal.signal(signal.SIGUSR1, nothing)
    with Interrupts() as interrupts:
        signal.raise_signal(signal.SIGHUP)
        signal.raise_signal(signal.SIGUSR1)  # which is the others' alone
        assert not interrupts.is_over
        signal.raise_signal(signal.SIGTERM)
        assert interrupts.status == 128 + signal.SIGTERM
    assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    assert signal.getsignal(signal.SIGTERM) is nothing
    assert signal.getsignal(signal.SIGUSR1) is nothing


def test_outside_of_the_main_thread_nothing_is_changed() -> None:
    seen: list[object] = []

    def live() -> None:
        with Interrupts() as interrupts:
            seen.extend((signal.getsignal(signal.SIGTERM), interrupts.is_over))

    thread = threading.Thread(target=live)
    thread.start()
    thread.join()
    assert seen == [signal.SIG_DFL, False]


def test_break_on_windows_ends_a_command_as_other_signals_do(as_on_windows: int) -> None:
    assert not Interrupts().is_over
    interrupts = Interrupts()
    interrupts.note(as_on_windows)
    assert interrupts.is_over
    assert interrupts.status == 128 + as_on_windows
    with pytest.raises(SystemExit) as ended:
        interrupts.go_on()
    assert ended.value.code == 128 + as_on_windows
