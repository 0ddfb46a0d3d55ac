"""Several logs at a time, in processes of their own; their rows come in the order of the logs."""

from __future__ import annotations

import multiprocessing
import signal
import tempfile
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import ExitStack
from ctypes import c_int64
from functools import partial
from pathlib import Path
from typing import Any

import pyarrow as pa

from typedcan.logs.pipeline import Options, Watch, read_rows
from typedcan.logs.protocol import Protocol
from typedcan.logs.summary import Summary
from typedcan.logs.write.sink import Files, Gathering, Sink, TableFile

_POLL = 0.1
"""Seconds between two looks at how far the others are."""

_PIECE = ".arrows"

_shared: list[Any] = []
"""In a process: the numbers that all share, and the protocol."""


class _Stopped(Exception):
    """The others are to give up."""


class _Piece(TableFile):
    """Rows of one log and table on their way to the process that writes."""

    def __init__(self, path: Path, schema: pa.Schema) -> None:
        options = pa.ipc.IpcWriteOptions(compression="lz4")
        self._writer = pa.ipc.new_stream(str(path), schema, options=options)

    def write(self, rows: pa.Table) -> None:
        """Add rows."""
        self._writer.write_table(rows)

    def close(self) -> None:
        """Finish the file."""
        self._writer.close()


def read_many(
    parts: Sequence[tuple[Path, float]],
    protocol: Protocol,
    options: Options,
    sink: Sink,
    jobs: int,
    watch: Watch,
) -> Summary:
    """Read logs in ``jobs`` processes and write their rows, log after log.

    A part is a log and how many seconds are added to its times. What is read ahead waits on disk,
    for ``jobs`` logs at most. Raises as `typedcan.logs.pipeline.read_rows`.
    """
    context = multiprocessing.get_context("spawn")
    # For each log its bytes and frames, and at the end whether to give up.
    numbers = context.RawArray(c_int64, 2 * len(parts) + 1)
    summary = Summary()
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="typedcan-")))
        pool = stack.enter_context(
            ProcessPoolExecutor(jobs, context, initializer=_set_up, initargs=(numbers, protocol))
        )
        pending: deque[tuple[int, Future[Summary]]] = deque()
        waiting = deque(enumerate(parts))
        try:
            while waiting or pending:
                while waiting and len(pending) < jobs + 1:
                    number, part = waiting.popleft()
                    work = pool.submit(_read_one, number, part, options, folder / str(number))
                    pending.append((number, work))
                number, future = pending.popleft()
                found = _result(future, partial(_tell, numbers, watch))
                _hand_on(folder / str(number), found, sink, first=summary.begin is None)
                summary.add(found)
        except BaseException:
            numbers[-1] = 1
            for _, future in pending:
                future.cancel()
            raise
    return summary


def _set_up(numbers: Any, protocol: Protocol) -> None:
    # Ctrl-C reaches all processes of a terminal; the one that started them sees to the others.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _shared[:] = [numbers, protocol]


def _read_one(number: int, part: tuple[Path, float], options: Options, folder: Path) -> Summary:
    folder.mkdir()
    sink = Files(_Piece, partial(_piece, folder))
    rows = Gathering(sink)
    path, later = part
    summary = read_rows(path, _shared[1], options, rows, partial(_note, number), later)
    rows.flush()
    sink.close()
    return summary


def _piece(folder: Path, name: str) -> Path:
    return folder / f"{name}{_PIECE}"


def _note(number: int, position: int, frames: int) -> None:
    """Say how far this log is; give up where the others are to."""
    numbers = _shared[0]
    numbers[2 * number : 2 * number + 2] = (position, frames)
    if numbers[-1]:
        raise _Stopped


def _tell(numbers: Any, watch: Watch) -> None:
    watch(sum(numbers[0:-1:2]), sum(numbers[1:-1:2]))


def _result(future: Future[Summary], look: Callable[[], None]) -> Summary:
    while True:
        look()
        try:
            return future.result(_POLL)
        except TimeoutError:
            continue


def _hand_on(folder: Path, found: Summary, sink: Sink, *, first: bool) -> None:
    """Write the rows of one log and remove what they waited in."""
    if first and found.begin is not None:
        sink.begin(found.begin)
    for name in found.rows:
        path = _piece(folder, name)
        with pa.OSFile(str(path), "rb") as source, pa.ipc.open_stream(source) as batches:
            for batch in batches:
                sink.write(name, pa.Table.from_batches([batch]))
        path.unlink()
