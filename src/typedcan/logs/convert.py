"""Logs to files of tables, and to tables in memory."""

from __future__ import annotations

import os
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import pyarrow as pa

from typedcan.logs.database import protocol_of
from typedcan.logs.parallel import read_many
from typedcan.logs.part import TimeError
from typedcan.logs.parts import check_order, parts_of
from typedcan.logs.pipeline import Layout, Options, Watch, read_rows, schemas_of
from typedcan.logs.protocol import Protocol
from typedcan.logs.summary import Summary
from typedcan.logs.write.behind import behind
from typedcan.logs.write.frame import Memory
from typedcan.logs.write.sink import Gathering, Sink
from typedcan.logs.write.target import OutputError, Target, target_of, writing


def convert_logs(
    logs: Sequence[Path],
    output: Path,
    options: Options | None = None,
    *,
    own: Protocol,
    jobs: int | None = None,
    force: bool = False,
    watch: Watch | None = None,
) -> tuple[Target, Summary]:
    """Convert logs to files of tables, which appear complete or not at all.

    Parameters
    ----------
    logs
        Parts of one drive. Where all of them say when they begin they are put in that order, else
        they are in it. Each is checked for itself.
    output
        A name whose suffix says which kind of file; see `typedcan.logs.write.target.target_of`.
    options
        What is to be made of the logs.
    own
        The protocol where the options give no database, and what is known of one made from it.
    jobs
        Logs that are read at a time; None: as many as there are cores.
    force
        Replace what is there.
    watch
        Is told how many bytes of all logs are read, and how many frames.

    Returns
    -------
    tuple[Target, Summary]
        Where the output is, and what was found.

    Raises
    ------
    TypedcanError
        An option is wrong, a log cannot be opened, or the output cannot be written. A log that is
        damaged raises nothing: `Summary.damage` says so.
    OSError
        While reading or writing.
    """
    chosen = options or Options()
    protocol = protocol_of(chosen.dbc, own)
    schemas = schemas_of(protocol, chosen)
    target = target_of(output, single=len(schemas) == 1)
    if target.suffix == ".mf4" and chosen.layout is Layout.LONG:
        raise OutputError(f"{output}: MF4 has a group per message, it holds no long table")
    if any(log.resolve() == target.path.resolve() for log in logs):
        raise OutputError(f"{target.path}: this is one of the logs")
    with writing(target, schemas, force=force) as sink, behind(sink) as queue:
        summary = _read(
            logs, protocol, chosen, queue, jobs or os.cpu_count() or 1, watch or _unwatched
        )
        if summary.outside and summary.begin is None and not summary.damage:
            raise TimeError(f"no frame in this part; the log goes from {summary.outside}")
    return target, summary


def tables(*logs: Path | str, options: Options | None = None, own: Protocol) -> dict[str, pa.Table]:
    """The tables of logs in memory, by name; ``table.to_pandas()`` or ``polars.from_arrow(table)``.

    Parameters
    ----------
    logs
        Parts of one drive, as `convert_logs` takes them.
    options
        What is to be made of the logs.
    own
        The protocol, as `convert_logs` has it.

    Raises
    ------
    TypedcanError
        An option is wrong, or a log cannot be opened. Of a damaged log the frames before the
        damage are there; `convert_logs` says what is lost.
    """
    memory = Memory()
    chosen = options or Options()
    protocol = protocol_of(chosen.dbc, own)
    _read([Path(log) for log in logs], protocol, chosen, memory, 1, _unwatched)
    return memory.tables()


def _read(
    logs: Sequence[Path],
    protocol: Protocol,
    options: Options,
    sink: Sink,
    jobs: int,
    watch: Watch,
) -> Summary:
    parts = parts_of(logs, options.window)
    jobs = min(jobs, len(parts))
    if jobs > 1:
        summary = read_many(parts, protocol, options, sink, jobs, watch)
    else:
        summary = _read_one_by_one(parts, protocol, options, sink, watch)
    check_order(summary.spans)
    return summary


def _read_one_by_one(
    parts: Sequence[tuple[Path, float]],
    protocol: Protocol,
    options: Options,
    sink: Sink,
    watch: Watch,
) -> Summary:
    summary = Summary()
    rows = _Once(sink)
    before = 0
    for log, later in parts:
        on = partial(_on, watch, before, summary.counts.frames)
        found = read_rows(log, protocol, options, rows, on, later)
        before += log.stat().st_size
        summary.add(found)
    rows.flush()
    return summary


class _Once(Gathering):
    """Says once when the first log begins."""

    _begun = False

    def begin(self, timestamp: float) -> None:
        """The time stamp of a log's first frame."""
        if not self._begun:
            self._begun = True
            super().begin(timestamp)


def _on(watch: Watch, before: int, frames_before: int, position: int, frames: int) -> None:
    """Say how far all logs are, from how far one is."""
    watch(before + position, frames_before + frames)


def _unwatched(position: int, frames: int) -> None:
    """Nobody wants to know."""
