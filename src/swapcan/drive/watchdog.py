"""Ends what acts where the program that commands it hangs: in a driver, a recorder, a callback."""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence
from types import TracebackType
from typing import Self

from swapcan.drive.noting_bus import NotingBus
from typedcan.wire.clock import Clock, SystemClock

_PATIENCE = 2.0
"""Seconds without a beat after which the program counts as hanging."""

_BETWEEN = 0.05
"""Seconds between two looks, and between two times the safe codes are sent."""


class Watchdog:
    """Within ``with`` the safe codes are sent by a thread of its own where no `beat` comes.

    On a simulated clock it does nothing: there no time passes while a program hangs.
    """

    def __init__(self, buses: Sequence[NotingBus], clock: Clock) -> None:
        self._buses = buses
        self._is_real = isinstance(clock, SystemClock)
        self._last = 0.0
        self._ended = threading.Event()
        self._thread: threading.Thread | None = None
        self.has_barked = False
        """Whether it had to."""

    def beat(self) -> None:
        """Say that the program goes on."""
        self._last = time.monotonic()

    def __enter__(self) -> Self:
        if self._is_real:
            self.beat()
            self._ended = threading.Event()
            self._thread = threading.Thread(
                target=self._watch, args=(self._ended,), name="swapcan-watchdog", daemon=True
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
            if time.monotonic() - self._last < _PATIENCE:
                continue
            for bus in self._buses:
                if bus.acting or (self.has_barked and bus.has_acted):
                    self.has_barked = True
                    bus.send_safe_codes()
