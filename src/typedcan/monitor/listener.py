"""The thread that hears a bus for a session, and goes on hearing when the bus comes back."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from types import TracebackType
from typing import Self

import can

from typedcan.monitor.session import Session
from typedcan.node.port import Port

_WAIT = 0.1
"""Seconds in one call of the bus: as long as it takes to stop."""


class Listener:
    """Takes every frame of a bus to a session, in one thread, from ``with`` to its end.

    Parameters
    ----------
    bus
        Is lent.
    session
        Is told of frames, and of the bus when it is lost and when it is back.
    reopen
        Opens the bus anew once it is lost; what it opened is closed here.
    """

    def __init__(
        self,
        bus: can.BusABC,
        session: Session,
        *,
        reopen: Callable[[], can.BusABC] | None = None,
    ) -> None:
        self._session = session
        self._port = Port(bus, session.clock, session.tell_bus, reopen=reopen)
        self._stopping = threading.Event()
        self._thread = ThreadPoolExecutor(1, "monitor")
        self._done: Future[None] = Future()

    @property
    def has_ended(self) -> bool:
        """Whether hearing ended by an error that nobody foresaw; leaving ``with`` raises it."""
        return self._done.done()

    def __enter__(self) -> Self:
        self._done = self._thread.submit(self._hear)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._stopping.set()
        self._thread.shutdown()
        self._port.close()
        if error is None:
            self._done.result()

    def _hear(self) -> None:
        session, port, now = self._session, self._port, self._session.clock.now
        while not self._stopping.is_set():
            frame = port.receive(_WAIT)
            if frame is not None:
                session.take(frame)
            elif port.retry_at is not math.inf:  # a lost bus returns at once
                self._stopping.wait(min(max(port.retry_at - now(), 0), _WAIT))
            if now() >= session.next_check:
                session.check()
