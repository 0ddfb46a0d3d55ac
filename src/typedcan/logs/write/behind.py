"""Writing in a thread of its own while the next frames are read: little of either is Python."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager

import pyarrow as pa

from typedcan.logs.write.sink import Sink

_PENDING = 4
"""Pieces that may wait to be written; they take memory."""


class _Behind:
    """Hands everything on, in its order, to a thread."""

    def __init__(self, sink: Sink, thread: ThreadPoolExecutor) -> None:
        self._sink = sink
        self._thread = thread
        self._pending: deque[Future[None]] = deque()

    def begin(self, timestamp: float) -> None:
        """The time stamp of the first frame."""
        self._pending.append(self._thread.submit(self._sink.begin, timestamp))

    def write(self, name: str, rows: pa.Table) -> None:
        """Add rows; raises what went wrong with earlier ones."""
        while len(self._pending) >= _PENDING:
            self._pending.popleft().result()
        self._pending.append(self._thread.submit(self._sink.write, name, rows))

    def close(self) -> None:
        """Wait until all is written; raises what went wrong. The sink stays open."""
        while self._pending:
            self._pending.popleft().result()

    def abort(self) -> None:
        """Leave out what waits."""
        for future in self._pending:
            future.cancel()


@contextmanager
def behind(sink: Sink) -> Iterator[Sink]:
    """A sink that writes to another in a thread; on leaving, all is written, or given up."""
    with ThreadPoolExecutor(1, "typedcan-write") as thread:
        queue = _Behind(sink, thread)
        try:
            yield queue
            queue.close()
        except BaseException:
            queue.abort()
            raise
