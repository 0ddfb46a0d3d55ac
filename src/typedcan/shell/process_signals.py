"""Signals that end or stop this process: first what acts gets its safe codes, then they do.

What cannot be caught, such as SIGKILL, a failing supply or a frozen machine, ends a process as it
is: then a pack's own timeout has to open its contactors.
"""

from __future__ import annotations

import logging
import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from types import FrameType, TracebackType
from typing import Any, Protocol, Self

_LOG = logging.getLogger("typedcan")

_TYPED_STOP = frozenset({"SIGTSTP"})
"""Ctrl-Z: stops a process until it is told to go on."""

_TERMINAL_STOP = frozenset({"SIGTTIN", "SIGTTOU"})
"""The same for a process that uses a terminal which is another's: it comes again and again."""

_ALWAYS = frozenset({"SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK"})
"""What a command takes over also where somebody has set a handler."""

_LEFT_ALONE = frozenset(
    {
        *("SIGKILL", "SIGSTOP"),  # cannot be caught
        *("SIGCHLD", "SIGCLD", "SIGCONT", "SIGURG", "SIGWINCH", "SIGINFO"),  # end nothing
        # Come of the process's own faults, which a handler in Python would come back to.
        *("SIGBUS", "SIGEMT", "SIGFPE", "SIGILL", "SIGSEGV", "SIGSYS", "SIGTRAP"),
        *(() if sys.platform == "linux" else ("SIGIO", "SIGPOLL")),  # end nothing elsewhere
    }
)

_STATUS = Path("/proc/self/status")
"""Where Linux says, as "SigCgt", which signals have a handler of whatever language."""

_PATIENCE = 3.0
"""Seconds for the last words, however many have some; a bus may hang."""

Handler = Callable[[int, FrameType | None], object]


def _numbers() -> frozenset[int]:
    """The signals that end or stop a process, Ctrl-C among them."""
    alone = {getattr(signal, name) for name in _LEFT_ALONE if hasattr(signal, name)}
    return frozenset(int(number) for number in signal.valid_signals()) - alone


def _caught() -> frozenset[int]:
    """The signals that have a handler, also one of which Python does not know, if one can tell."""
    try:
        lines = _STATUS.read_text("ascii", "replace").splitlines()
    except OSError:
        return frozenset()
    masks = [int(line.split()[1], 16) for line in lines if line.startswith("SigCgt:")]
    return frozenset(bit + 1 for mask in masks for bit in range(64) if mask >> bit & 1)


def _is_one_of(number: int, names: frozenset[str]) -> bool:
    return any(number == getattr(signal, name, None) for name in names)


def _install(numbers: frozenset[int], handler: Handler, always: frozenset[str]) -> dict[int, Any]:
    """Set a handler for signals to which nobody listens; what was there before, by number.

    Those of ``always`` are taken from others too, unless they are ignored. Outside of the main
    thread, which alone gets signals, nothing is set.
    """
    before: dict[int, Any] = {}
    if threading.current_thread() is not threading.main_thread():
        return before
    caught = _caught()
    for number in numbers:
        present = signal.getsignal(number)
        if present is signal.SIG_DFL:
            wanted = number not in caught  # by what is not written in Python: faulthandler
        else:
            wanted = present not in (signal.SIG_IGN, None) and _is_one_of(number, always)
        if wanted:
            try:
                signal.signal(number, handler)
            except (OSError, ValueError):  # the system keeps it for itself
                continue
            before[number] = present
    return before


def _let_it(number: int, handler: Handler) -> None:
    """Let a signal do what it does by itself; returns where that only stopped the process."""
    signal.signal(number, signal.SIG_DFL)
    signal.raise_signal(number)
    signal.signal(number, handler)


def _restore(before: dict[int, Any]) -> None:
    for number, handler in before.items():
        signal.signal(number, handler)


class Interrupts:
    """Within ``with`` signals interrupt nothing: ``is_over`` says that one has come.

    A signal that is ignored stays ignored, as with nohup; outside of the main thread nothing is
    changed.

    ``at_once`` is done before a signal stops the process that cannot wait for its end. While
    ``hangs`` says that the program hangs, a signal that ends it breaks into what it hangs in, by
    `KeyboardInterrupt` or `SystemExit`.
    """

    def __init__(self) -> None:
        self.at_once: Callable[[], object] = lambda: None
        self.hangs: Callable[[], bool] = lambda: False
        self._typed = 0
        self._ending: int | None = None
        self._stopping: int | None = None
        self._stopped_by: int | None = None
        self._before: dict[int, Any] = {}

    @property
    def is_over(self) -> bool:
        """Whether it is time to end."""
        asked = self._typed > 0 or self._ending is not None or self._stopping is not None
        return asked or self._stopped_by is not None

    @property
    def status(self) -> int | None:
        """The exit status of a command that a signal has ended: 128 and its number; else None."""
        number = self._ending or (signal.SIGINT if self._typed else None) or self._stopped_by
        return None if number is None else 128 + number

    def stop_if_asked(self) -> None:
        """Stop the process where Ctrl-Z has asked for that, now that nothing acts any more.

        Returns once the process is told to go on; ``is_over`` stays.
        """
        if self._stopping is not None:
            number, self._stopping = self._stopping, None
            self._stopped_by = number
            _let_it(number, self.note)

    def go_on(self) -> None:
        """Leave the program where more than one Ctrl-C has asked for that.

        Raises `KeyboardInterrupt` after a second Ctrl-C, `SystemExit` after a signal that ends a
        process: 128 and its number.
        """
        if self._ending is not None:
            raise SystemExit(128 + self._ending)
        if self._typed > 1:
            raise KeyboardInterrupt

    def __enter__(self) -> Self:
        self._before = _install(_numbers(), self.note, _ALWAYS)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        _restore(self._before)

    def note(self, number: int, _frame: FrameType | None = None) -> None:
        """Take notice of a signal; what is set as its handler."""
        if number == signal.SIGINT:
            self._typed += 1
            if self.hangs():
                raise KeyboardInterrupt
        elif _is_one_of(number, _TYPED_STOP):
            self._stopping = number
        elif _is_one_of(number, _TERMINAL_STOP):
            self._stopped_by = number
            try:
                self.at_once()
            except Exception:  # noqa: BLE001 - it is to stop all the same
                _LOG.exception("what was to be done before a signal has failed")
            _let_it(number, self.note)
        else:
            self._ending = number
            if self.hangs():
                raise SystemExit(128 + number)


class Speaker(Protocol):
    """Who has something to do before a signal ends or stops the process."""

    def speak_last(self) -> None:
        """Do it, in a thread of its own, while the main thread stands still wherever it was."""
        ...

    def go_on(self) -> None:
        """The process was only stopped, and goes on; is called in the main thread.

        What this raises is raised in what the signal has interrupted.
        """
        ...


class LastWords:
    """What is still to be done when a signal ends or stops the process.

    Handlers are set while there is something to do, only for signals to which nobody else listens:
    Ctrl-C for example is an exception in Python, unless somebody has undone that. After the last
    words the signal does what it would have done.
    """

    def __init__(self) -> None:
        self._speakers: tuple[Speaker, ...] = ()
        self._before: dict[int, Any] = {}
        self._lock = threading.RLock()

    def add(self, speaker: Speaker) -> None:
        """Have somebody say what is left to say."""
        with self._lock:
            self._speakers = (*self._speakers, speaker)
            self._before |= _install(_numbers(), self._speak, frozenset())

    def discard(self, speaker: Speaker) -> None:
        """Let somebody say nothing any more."""
        with self._lock:
            self._speakers = tuple(each for each in self._speakers if each is not speaker)
            if not self._speakers and threading.current_thread() is threading.main_thread():
                self._take_off()

    def forget(self) -> None:
        """Let nobody say anything: this process is a copy of the one in which they live."""
        self._lock = threading.RLock()  # another thread may have held it, which is not here
        self._speakers = ()
        self._take_off()

    def _take_off(self) -> None:
        before, self._before = self._before, {}
        for number, handler in before.items():
            if signal.getsignal(number) == self._speak:  # what somebody has set since is theirs
                signal.signal(number, handler)

    def _speak(self, number: int, _frame: FrameType | None) -> None:
        speakers = self._speakers
        # Not in this thread: it may hold any lock, and a bus that hangs must not hold it up.
        threads = [_started(each.speak_last) for each in speakers]
        end = time.monotonic() + _PATIENCE
        for thread in threads:
            if thread:
                thread.join(max(end - time.monotonic(), 0))
        _let_it(number, self._speak)
        for each in speakers:
            each.go_on()


def _started(action: Callable[[], object]) -> threading.Thread | None:
    """The thread in which something is being done; None where it had to be done here."""
    thread = threading.Thread(target=action, name="typedcan-last-words", daemon=True)
    try:
        thread.start()
    except RuntimeError:  # the interpreter is ending, or there are too many threads
        action()
        return None
    return thread


LAST_WORDS = LastWords()
"""Of this process."""

if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=LAST_WORDS.forget)
