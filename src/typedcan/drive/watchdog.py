"""Ends what acts where the program that commands it hangs: in a driver, a recorder, a callback."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from types import TracebackType
from typing import Self

from typedcan.drive.noting_bus import NotingBus
from typedcan.model.errors import TypedcanError
from typedcan.node.clock import Clock, SystemClock

HUNG = "the program stands still: what acts was ended; Ctrl-C, or else kill -9, ends the program"
"""What people are told where a driver, a recorder or an output does not come back."""

_PATIENCE = 2.0
"""Seconds without a beat after which the program counts as hanging."""

_BETWEEN = 0.05
"""Seconds between two looks, and between two times the safe codes are sent."""

_SLEEPLESS = getattr(time, "CLOCK_BOOTTIME", None)
"""A clock that goes on while the machine sleeps, where there is one (Linux)."""


class HungError(TypedcanError):
    """What drives a bus stood still for too long, and what acts was ended."""

    def __init__(self) -> None:
        super().__init__(
            f"the program stood still for more than {_PATIENCE:g} s: what acts was ended"
        )


class Watchdog:
    """Within ``with`` the safe codes are sent by a thread of its own where no `beat` comes.

    After that nothing that acts goes out any more, also where the program or the machine was
    stopped as a whole. On a simulated clock it does nothing: there no time passes while a program
    hangs.

    Parameters
    ----------
    warn
        Is told once, in a thread of its own, that the safe codes had to be sent.
    """

    def __init__(
        self,
        buses: Sequence[NotingBus],
        clock: Clock,
        warn: Callable[[], object] = lambda: None,
    ) -> None:
        self._buses = buses
        self._is_real = isinstance(clock, SystemClock)
        self._warn = warn
        self._last = 0.0
        self._ended = threading.Event()
        self._thread: threading.Thread | None = None
        self.has_barked = False
        """Whether it had to."""
        for bus in buses:
            bus.may_act = self.check

    @property
    def is_late(self) -> bool:
        """Whether no beat has come for too long."""
        return self._thread is not None and _now() - self._last >= _PATIENCE

    def check(self) -> None:
        """Raise `HungError` where the program hung while something acted."""
        if self.is_late and any(bus.acting for bus in self._buses):
            self.has_barked = True
        if self.has_barked:
            raise HungError

    def beat(self) -> None:
        """Say that the program goes on."""
        self._last = _now()

    def __enter__(self) -> Self:
        if self._is_real:
            self.beat()
            self._ended = threading.Event()
            self._thread = threading.Thread(
                target=self._watch, args=(self._ended,), name="typedcan-watchdog", daemon=True
            )
            self._thread.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._ended.set()
        if self._thread:
            self._thread.join(_PATIENCE)
            self._thread = None

    def _watch(self, ended: threading.Event) -> None:
        while not ended.wait(_BETWEEN):
            if self.is_late:
                with suppress(Exception):  # it looks again
                    self._bark()

    def _bark(self) -> None:
        """Send the safe codes, again and again: one frame can get lost."""
        acting = any(bus.acting for bus in self._buses)
        if not acting and not self.has_barked:
            return
        first, self.has_barked = not self.has_barked, True
        for bus in self._buses:
            bus.send_safe_codes()
        if first:  # what it writes to may be what the program hangs in
            threading.Thread(target=self._warn, name="typedcan-warning", daemon=True).start()


def _now() -> float:
    return time.monotonic() if _SLEEPLESS is None else float(time.clock_gettime(_SLEEPLESS))
