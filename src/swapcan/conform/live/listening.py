"""Hearing a bus for a while."""

from __future__ import annotations

import time
from collections.abc import Callable

import can

_WAIT = 0.1
"""Seconds in one call of the bus: as long as it takes to end."""


def listen(
    bus: can.BusABC,
    seconds: float,
    note: Callable[[can.Message], object],
    *,
    is_over: Callable[[], bool] = lambda: False,
    watch: Callable[[float, float], object] = lambda _passed, _all: None,
) -> None:
    """Take every frame of a bus for so many seconds, or until it is over; nothing is sent.

    Parameters
    ----------
    note
        Is told of each frame.
    watch
        Is told now and then how many seconds have passed, and of how many.

    Raises
    ------
    can.CanError, OSError
        The bus does not work.
    """
    begin = time.monotonic()
    while (passed := time.monotonic() - begin) < seconds and not is_over():
        frame = bus.recv(min(seconds - passed, _WAIT))
        if frame:
            note(frame)
        watch(passed, seconds)
