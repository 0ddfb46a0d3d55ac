"""One life of a node, from its start to its stop."""

from __future__ import annotations

import threading


class Life:
    """What the threads of a node know of each other.

    Its facts are plain attributes, without locks: a signal may come, and have to change one, while
    the main thread reads it.
    """

    __slots__ = ("failed", "is_over", "stand_in")

    def __init__(self) -> None:
        self.is_over = False
        """Whether the threads are to end."""
        self.failed = False
        """Whether one of them could not go on, or hangs: nothing more is sent but safe codes."""
        self.stand_in: threading.Thread | None = None
        """The thread that lets time pass while the one that receives hangs."""


def wait_for(thread: threading.Thread | None, seconds: float) -> None:
    """Wait for the end of a thread, at most so long."""
    # A callback may stop its node; one of the threads may not have been started.
    if thread and thread is not threading.current_thread() and thread.is_alive():
        thread.join(seconds)
