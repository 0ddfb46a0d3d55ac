"""Running the view in a terminal, which is left as it was however the view ends."""

from __future__ import annotations

import asyncio
import os
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

from typedcan.monitor.session import Session
from typedcan.monitor.view.app import INTERRUPTED, MonitorApp

_SIGNALS = {"SIGINT": INTERRUPTED, "SIGTERM": 143}
"""What ends the view in order, with its exit status."""

_HUNG_UP = 129


def run_view(
    session: Session,
    bus: str,
    *,
    name_filter: str,
    record_name: str,
    is_over: Callable[[], bool],
) -> int:
    """Show a session until it is left, and return the exit status; as `MonitorApp`.

    Where the terminal goes away the process ends, once the recording is closed.
    """
    app = MonitorApp(
        session, bus, name_filter=name_filter, record_name=record_name, is_over=is_over
    )
    with _ending_with_the_terminal(session):
        return asyncio.run(_run(app))


async def _run(app: MonitorApp) -> int:
    loop = asyncio.get_running_loop()
    for name, status in _SIGNALS.items():
        try:
            loop.add_signal_handler(getattr(signal, name), app.exit, status)
        except NotImplementedError:  # Windows: Ctrl-C arrives as a key
            break
    result = await app.run_async()
    return app.return_code or 0 if result is None else result


@contextmanager
def _ending_with_the_terminal(session: Session) -> Iterator[None]:
    """Let SIGHUP end the process: Textual would wait for ever to write to what is gone."""
    number = getattr(signal, "SIGHUP", None)
    if number is None or signal.getsignal(number) is signal.SIG_IGN:
        yield
        return

    def leave() -> None:
        session.stop_recording()
        os._exit(_HUNG_UP)

    def hang_up(_number: int, _frame: FrameType | None) -> None:
        # In a thread: the one that is interrupted may hold what closing the file waits for.
        threading.Thread(target=leave).start()

    before = signal.signal(number, hang_up)
    try:
        yield
    finally:
        signal.signal(number, before)
