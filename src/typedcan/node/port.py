"""The bus as a live node sees it: it may go away, and it is tried again until it is back."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from contextlib import suppress

import can

from typedcan.model.errors import one_line
from typedcan.node.clock import Clock
from typedcan.node.events import BusBack, BusLost

_FIRST_RETRY = 0.05
_LAST_RETRY = 2.0
"""Seconds between two attempts to receive: at first, and at most."""


class Port:
    """A bus that is lent, and the ones that are opened in its place once it is lost.

    One thread may send while another one receives, if the bus lets them.

    Parameters
    ----------
    bus
        Is never closed here.
    report
        Is called, in the thread that notices it, when the bus is lost and when it is back.
    reopen
        Opens another bus where the one at hand does not work any more. What it opened is closed
        here.
    """

    def __init__(
        self,
        bus: can.BusABC,
        clock: Clock,
        report: Callable[[BusLost | BusBack], None],
        *,
        reopen: Callable[[], can.BusABC] | None = None,
    ) -> None:
        self._bus = bus
        self._clock = clock
        self._report = report
        self._reopen = reopen
        self.on_new_bus: Callable[[], None] | None = None
        """Is called once another bus is in place."""
        self._owns_bus = False
        # Reentrant, as a signal may come here too.
        self._lock = threading.RLock()
        self._opening = threading.Lock()
        self._broken: set[str] = set()  # directions: "receive", "send"
        self._retry_at = math.inf
        self._delay = _FIRST_RETRY

    @property
    def bus(self) -> can.BusABC:
        """The bus in use."""
        return self._bus

    @property
    def retry_at(self) -> float:
        """When it is worth to receive again; `math.inf` while the bus works."""
        return self._retry_at

    def send(self, frame: can.Message) -> None:
        """Send a frame, or raise what the bus raises, be it what it may.

        Nothing waits for a full queue: one that does not empty would hold up all other messages.
        """
        try:
            self._bus.send(frame, timeout=0)
        except Exception as error:
            self._fails("send", error)
            raise
        if self._broken:
            self._works("send")

    def receive(self, timeout: float) -> can.Message | None:
        """The next frame; None where none arrives in ``timeout`` seconds or the bus is lost.

        Any exception of the bus, and of opening another one, counts as lost.

        While it is lost this returns at once, and touches the bus only at `retry_at`.
        """
        try:
            if self._retry_at == math.inf:
                return self._bus.recv(timeout)
            return self._try_again() if self._clock.now() >= self._retry_at else None
        except Exception as error:  # noqa: BLE001 - drivers raise what they like
            self._retry_at = self._clock.now() + self._delay
            self._delay = min(2 * self._delay, _LAST_RETRY)
            self._fails("receive", error)
            return None

    def renew(self) -> None:
        """Open another bus now where the one at hand is lost; raises what that raises.

        One that refuses to send only may just have a full queue, but this is the last time to ask.
        """
        if self._broken and self._reopen:
            self._open_another(self._reopen)

    def close(self) -> None:
        """Close the bus if it was opened here."""
        if self._owns_bus:
            self._owns_bus = False
            self._bus.shutdown()

    def _try_again(self) -> can.Message | None:
        try:
            frame = self._bus.recv(0)
        except Exception:
            if self._reopen is None:
                raise
            frame = self._open_another(self._reopen).recv(0)
        self._retry_at = math.inf
        self._delay = _FIRST_RETRY
        self._works("receive")
        return frame

    def _open_another(self, reopen: Callable[[], can.BusABC]) -> can.BusABC:
        if not self._opening.acquire(blocking=False):
            raise can.CanInitializationError("another bus is being opened already")
        try:
            with suppress(Exception):  # a bus that is gone need not be closed
                self.close()  # before the new one: most adapters can be open only once
            bus = reopen()
            if not isinstance(bus, can.BusABC):  # the one at hand may still send
                raise can.CanInitializationError(f"reopen gave {type(bus).__name__}, not a bus")
            self._bus = bus
            self._owns_bus = True
        finally:
            self._opening.release()
        if self.on_new_bus:
            self.on_new_bus()
        return self._bus

    def _fails(self, direction: str, error: Exception) -> None:
        with self._lock:
            first = not self._broken
            self._broken.add(direction)
        if first:
            self._report(BusLost(one_line(error), self._clock.now()))

    def _works(self, direction: str) -> None:
        with self._lock:
            was_broken = direction in self._broken
            self._broken.discard(direction)
            back = was_broken and not self._broken
        if back:
            self._report(BusBack(self._clock.now()))
