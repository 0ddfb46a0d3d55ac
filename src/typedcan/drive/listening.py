"""Hearing a bus for a while."""

from __future__ import annotations

import time
from collections.abc import Callable

import can

_WAIT = 0.1
"""Seconds in one call of the bus: as long as it takes to end."""

_PAUSE = 0.02
"""Seconds until a bus that has raised is tried again."""

_TROUBLE = 1.0
"""Seconds for which a bus may raise before it is given up."""


def listen(
    bus: can.BusABC,
    seconds: float,
    note: Callable[[can.Message], object],
    *,
    is_over: Callable[[], bool] = lambda: False,
    watch: Callable[[float, float], object] = lambda _passed, _all: None,
    report: Callable[[Exception], object] = lambda _: None,
) -> None:
    """Take every frame of a bus for so many seconds, or until it is over; nothing is sent.

    Parameters
    ----------
    note
        Is told of each frame.
    watch
        Is told now and then how many seconds have passed, and of how many.
    report
        Is told what the bus has raised, be it what it may, once it works again.

    Raises
    ------
    Exception
        What the bus has raised for a second, and what ``note`` raises.
    """
    begin = works = time.monotonic()
    trouble: Exception | None = None
    while (passed := time.monotonic() - begin) < seconds and not is_over():
        try:
            frame = bus.recv(min(seconds - passed, _WAIT))
        except Exception as error:
            if time.monotonic() - works >= _TROUBLE:
                raise
            trouble = trouble or error
            time.sleep(_PAUSE)
            continue
        works = time.monotonic()
        if trouble:
            report(trouble)
            trouble = None
        if frame:
            note(frame)
        watch(passed, seconds)
