"""Signals that end or stop this process: first what acts gets its safe codes, then they do.

What cannot be caught, such as SIGKILL, a failing supply or a frozen machine, ends a process as it
is: then a pack's own timeout has to open its contactors.
"""

from __future__ import annotations

import logging
import signal
import threading
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import Any, Self

_LOG = logging.getLogger("swapcan")

_TYPED_STOP = frozenset({"SIGTSTP"})
"""Ctrl-Z: stops a process until it is told to go on."""

_TERMINAL_STOP = frozenset({"SIGTTIN", "SIGTTOU"})
"""The same for a process that uses a terminal which is another's: it comes again and again."""

_ALWAYS = frozenset({"SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK"})
"""What a command takes over also where somebody has set a handler."""

_LEFT_ALONE = frozenset(
    {
        *("SIGKILL", "SIGSTOP"),  # cannot be caught
        *("SIGCHLD", "SIGCLD", "SIGCONT", "SIGURG", "SIGWINCH"),  # end nothing
        *("SIGPIPE", "SIGXFSZ"),  # Python ignores them, and raises OSError
        # Come of the process's own faults: after them nothing works for certain.
        *("SIGABRT", "SIGIOT", "SIGBUS", "SIGFPE", "SIGILL", "SIGSEGV", "SIGSYS", "SIGTRAP"),
        *("SIGEMT", "SIGSTKFLT"),
    }
)

Handler = Callable[[int, FrameType | None], object]


def _numbers() -> frozenset[int]:
    """The signals that end or stop a process, Ctrl-C among them."""
    alone = {getattr(signal, name) for name in _LEFT_ALONE if hasattr(signal, name)}
    return frozenset(int(number) for number in signal.valid_signals()) - alone


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
    for number in numbers:
        present = signal.getsignal(number)
        others = present not in (signal.SIG_IGN, None) and _is_one_of(number, always)
        if present is signal.SIG_DFL or others:
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
            self.at_once()
            _let_it(number, self.note)
        else:
            self._ending = number
            if self.hangs():
                raise SystemExit(128 + number)


class LastWords:
    """What is still to be done when a signal ends or stops the process.

    Handlers are set while there is something to do, only for signals to which nobody else listens,
    and never for Ctrl-C, which is an exception in Python. After the last words the signal does
    what it would have done.
    """

    def __init__(self) -> None:
        self._actions: list[Callable[[], object]] = []
        self._before: dict[int, Any] = {}
        self._lock = threading.RLock()

    def add(self, action: Callable[[], object]) -> None:
        """Have something done; it has to be quick, and works beside any thread."""
        with self._lock:
            self._actions.append(action)
            if not self._before:
                numbers = _numbers() - {signal.SIGINT}
                self._before = _install(numbers, self._speak, frozenset())

    def discard(self, action: Callable[[], object]) -> None:
        """Have it done no more, if it was to be."""
        with self._lock:
            if action in self._actions:
                self._actions.remove(action)
            if not self._actions and threading.current_thread() is threading.main_thread():
                before, self._before = self._before, {}
                # What somebody has set meanwhile is theirs.
                mine = {number: old for number, old in before.items() if self._is_mine(number)}
                _restore(mine)

    def _is_mine(self, number: int) -> bool:
        return signal.getsignal(number) == self._speak

    def _speak(self, number: int, _frame: FrameType | None) -> None:
        for action in tuple(self._actions):
            try:
                action()
            except Exception:  # noqa: BLE001 - the others are to have theirs
                _LOG.exception("what was to be done before a signal has failed")
        _let_it(number, self._speak)


LAST_WORDS = LastWords()
"""Of this process."""
