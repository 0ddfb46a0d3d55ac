"""Signals are noted and end nothing by themselves, so that what drives a pack can leave it."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator

import pytest

from typedcan.shell import process_signals
from typedcan.shell.process_signals import Interrupts

NAMES = [
    *("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT", "SIGUSR1", "SIGUSR2", "SIGALRM", "SIGVTALRM"),
    *("SIGPROF", "SIGIO", "SIGXCPU", "SIGPWR", "SIGRTMIN", "SIGRTMAX", "SIGBREAK"),
]
HERE = [name for name in NAMES if hasattr(signal, name)]

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="untested on Windows")


@pytest.fixture(autouse=True)
def _handlers_come_back() -> Iterator[None]:
    numbers = signal.valid_signals()
    signal.signal(signal.SIGINT, signal.default_int_handler)
    before = {number: signal.getsignal(number) for number in numbers}
    yield
    assert {number: signal.getsignal(number) for number in numbers} == before


@pytest.mark.parametrize("name", HERE)
def test_a_signal_that_ends_a_process_is_noted_and_becomes_its_status(name: str) -> None:
    number = getattr(signal, name)
    with Interrupts() as interrupts:
        assert (interrupts.is_over, interrupts.status) == (False, None)
        signal.raise_signal(number)
    assert interrupts.is_over
    assert interrupts.status == 128 + number


def test_what_ends_a_process_goes_before_ctrl_c_and_that_before_ctrl_z() -> None:
    with Interrupts() as interrupts:
        signal.raise_signal(signal.SIGTSTP)
        assert interrupts.is_over
        signal.raise_signal(signal.SIGINT)
        assert interrupts.status == 128 + signal.SIGINT
        signal.raise_signal(signal.SIGTERM)
        assert interrupts.status == 128 + signal.SIGTERM


def test_what_is_ignored_stays_ignored_as_with_nohup() -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with Interrupts() as interrupts:
            signal.raise_signal(signal.SIGHUP)
        assert not interrupts.is_over
    finally:
        signal.signal(signal.SIGHUP, before)


def test_signals_that_end_no_process_are_left_alone() -> None:
    with Interrupts() as interrupts:
        for name in ("SIGCHLD", "SIGCONT", "SIGWINCH", "SIGURG"):
            signal.raise_signal(getattr(signal, name))
    assert not interrupts.is_over


def test_outside_of_the_main_thread_nothing_is_changed() -> None:
    found = []

    def enter() -> None:
        with Interrupts():
            found.append(signal.getsignal(signal.SIGTERM))

    thread = threading.Thread(target=enter)
    thread.start()
    thread.join()
    assert found == [signal.getsignal(signal.SIGTERM)]


@pytest.fixture
def let_it(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """What would stop this process is only told of."""
    told: list[object] = []
    monkeypatch.setattr(process_signals, "_let_it", lambda number, _: told.append(number))
    return told


def test_ctrl_z_stops_the_process_where_it_may_and_once(let_it: list[object]) -> None:
    with Interrupts() as interrupts:
        interrupts.stop_if_asked()
        signal.raise_signal(signal.SIGTSTP)
        assert let_it == []
        interrupts.stop_if_asked()
        interrupts.stop_if_asked()
        assert let_it == [signal.SIGTSTP]
        assert interrupts.is_over  # after fg too
        assert interrupts.status == 128 + signal.SIGTSTP


@pytest.mark.parametrize("name", ["SIGTTIN", "SIGTTOU"])
def test_what_stops_a_process_at_its_terminal_comes_after_the_safe_codes(
    name: str, let_it: list[object]
) -> None:
    number = getattr(signal, name)
    with Interrupts() as interrupts:
        interrupts.at_once = lambda: let_it.append("safe codes")
        signal.raise_signal(number)
        assert let_it == ["safe codes", number]
        assert interrupts.is_over


def test_where_the_program_hangs_a_signal_breaks_into_that() -> None:
    with Interrupts() as interrupts:
        interrupts.hangs = lambda: True
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        with pytest.raises(SystemExit, match=str(128 + signal.SIGTERM)):
            signal.raise_signal(signal.SIGTERM)
        assert interrupts.is_over


def test_the_break_of_windows_ends_a_command_as_the_others_do(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # Its handler is called here; on Windows it is untested.
    for name in ("SIGTTIN", "SIGTTOU", "SIGTSTP"):
        monkeypatch.delattr(signal, name)
    monkeypatch.setattr(signal, "SIGBREAK", 21, raising=False)
    interrupts = Interrupts()
    interrupts.note(21, None)
    assert interrupts.is_over
    assert interrupts.status == 149
    with pytest.raises(SystemExit, match="149"):
        interrupts.go_on()
