"""Ctrl-C, and the signals that end a process, as something to ask for instead of an exception."""

from __future__ import annotations

import signal
import threading
from types import FrameType, TracebackType
from typing import Any, Self

_ENDING = {"SIGTERM": 143, "SIGHUP": 129, "SIGBREAK": 149}
"""What ends a process beside Ctrl-C, and the exit status that tells of it."""


class Interrupts:
    """Within ``with`` signals interrupt nothing: ``is_over`` says that one has come.

    A signal that is ignored stays ignored, as with nohup; outside of the main thread, which
    alone gets signals, nothing is changed.
    """

    def __init__(self) -> None:
        self._typed = 0
        self._status: int | None = None
        self._before: dict[int, Any] = {}

    @property
    def is_over(self) -> bool:
        """Whether it is time to end."""
        return self._typed > 0 or self._status is not None

    def go_on(self) -> None:
        """Leave the program where more than one Ctrl-C has asked for that.

        Raises `KeyboardInterrupt` after a second Ctrl-C, `SystemExit` after another signal.
        """
        if self._status is not None:
            raise SystemExit(self._status)
        if self._typed > 1:
            raise KeyboardInterrupt

    def __enter__(self) -> Self:
        if threading.current_thread() is threading.main_thread():
            for name in ("SIGINT", *_ENDING):
                number = getattr(signal, name, None)
                if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
                    self._before[number] = signal.signal(number, self._note)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _note(self, number: int, _frame: FrameType | None) -> None:
        if number == signal.SIGINT:
            self._typed += 1
        else:
            self._status = _ENDING[signal.Signals(number).name]
