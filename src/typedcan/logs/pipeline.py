"""From one log to the rows of tables."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from enum import Enum
from fractions import Fraction
from pathlib import Path
from typing import Protocol as Interface

import numpy as np
import pyarrow as pa

from typedcan.logs.arrow import MessageTable, message_tables
from typedcan.logs.checks import Checks
from typedcan.logs.decode import Decoder
from typedcan.logs.frames import FrameBlock
from typedcan.logs.long_table import LongTable
from typedcan.logs.part import ALL, LogPart, Window
from typedcan.logs.plan import Mode
from typedcan.logs.protocol import Protocol
from typedcan.logs.raster import Raster
from typedcan.logs.selection import select
from typedcan.logs.shapes import PerMessage, Shape
from typedcan.logs.summary import Summary
from typedcan.model.checksums.methods import Algorithm
from typedcan.model.checksums.registry import Given

_BLOCK = 1 << 17
"""Frames in a block: large enough that a message's share of it is worth a call per column."""


class Layout(Enum):
    """``MESSAGES``: a table per message. ``LONG``: a row per signal. ``RASTER``: a wide table."""

    MESSAGES = "messages"
    LONG = "long"
    RASTER = "raster"


Derive = Callable[[Protocol], Shape]
"""Makes what derives further tables from the decoded blocks of one log."""


@dataclass(frozen=True, slots=True)
class Options:
    """What is to be made of a log.

    Parameters
    ----------
    dbc
        A DBC file, or another database; None: the protocol that comes with the options.
    messages, signals
        Names, as `typedcan.logs.selection.select` takes them; none: all.
    window
        The part of each log.
    mode
        What the columns hold.
    layout
        Which tables.
    step
        Seconds of the raster, where that is the layout.
    keep_faulty
        Keep frames with a wrong length or checksum.
    algorithms
        What computes checksums that are not known here, as `typedcan.wire.codec.Codec` has it. To
        work on several logs at once, they must be functions of modules.
    derived
        Further tables. To work on several logs at once, they must be functions of modules.
    """

    dbc: Path | None = None
    messages: tuple[str, ...] = ()
    signals: tuple[str, ...] = ()
    window: Window = ALL
    mode: Mode = Mode.PHYSICAL
    layout: Layout = Layout.MESSAGES
    step: Fraction = Fraction(1, 10)
    keep_faulty: bool = False
    algorithms: Given = field(default_factory=dict[str, Algorithm | str])
    derived: tuple[Derive, ...] = ()


class Rows(Interface):
    """Takes what a log gives, in its order."""

    def begin(self, timestamp: float) -> None:
        """Learn the time stamp of the first frame; once, before the first rows."""
        ...

    def add(self, name: str, batch: pa.RecordBatch) -> None:
        """Take rows of the table of that name."""
        ...


Watch = Callable[[int, int], None]
"""Is told, now and then, how many bytes of a log are read, and how many frames."""


def shapes_of(protocol: Protocol, options: Options) -> list[Shape]:
    """What makes the tables, for one log.

    Raises
    ------
    SelectionError
        There is no message or signal of a name that was asked for.
    """
    wanted = select(protocol, options.messages, options.signals)
    return _shapes(protocol, options, message_tables(protocol, wanted, options.mode))


def _shapes(
    protocol: Protocol, options: Options, tables: Mapping[str, MessageTable]
) -> list[Shape]:
    shape: Shape
    if options.layout is Layout.LONG:
        shape = LongTable(protocol, tables)
    elif options.layout is Layout.RASTER:
        shape = Raster(protocol, tables, options.step)
    else:
        shape = PerMessage(tables)
    return [shape, *(derive(protocol) for derive in options.derived)]


def schemas_of(protocol: Protocol, options: Options) -> dict[str, pa.Schema]:
    """The tables that there can be, by name; raises as `shapes_of`."""
    shapes = shapes_of(protocol, options)
    return {name: schema for shape in shapes for name, schema in shape.schemas.items()}


def read_rows(
    path: Path,
    protocol: Protocol,
    options: Options,
    rows: Rows,
    watch: Watch,
    later: float = 0.0,
) -> Summary:
    """Read one log, and hand on the rows of its tables, their times so many seconds later.

    Raises
    ------
    LogError
        The log cannot be opened.
    SelectionError, TimeError, AlgorithmError
        The options are wrong.
    """
    wanted = select(protocol, options.messages, options.signals)
    decoder = Decoder(
        protocol.messages, mode=options.mode, reserved=protocol.reserved, wanted=wanted
    )
    checks = Checks(protocol, keep_faulty=options.keep_faulty, algorithms=options.algorithms)
    tables = message_tables(protocol, wanted, options.mode)
    shapes = _shapes(protocol, options, tables)
    summary = Summary(logs=1, hidden=protocol.hidden, in_several_frames=protocol.in_several_frames)
    if options.layout is Layout.MESSAGES:
        for table in tables.values():
            summary.renamed.update(table.renamed)
    span = _Span()
    with LogPart(path, _BLOCK, options.window, later) as log:
        for block in _watched(log, watch):
            if summary.begin is None:
                summary.begin = float(block.timestamp[0])
                rows.begin(summary.begin)
            span.add(block)
            decoded = checks.take(decoder.decode(block))
            summary.counts.add(decoded.counts)
            for shape in shapes:
                _hand_on(shape.take(decoded), rows, summary)
        if log.damage is not None:
            summary.damage.append(log.damage)
        summary.spans.append((path, log.first, log.last))
        summary.outside = log.spans() if summary.begin is None else ""
        if log.clock.text:
            summary.begun.append(f"{path.name} began {log.clock.text}")
        summary.passed.update(log.passed)
    for shape in shapes:
        _hand_on(shape.finish(), rows, summary)
        summary.add_problems(shape.problems)
        summary.add_recognised(shape.recognised)
        summary.add_sources(shape.taken_together)
    summary.faults = checks.finish()
    summary.seconds = span.seconds
    return summary


def _watched(log: LogPart, watch: Watch) -> Iterator[FrameBlock]:
    frames = 0
    for block in log:
        yield block
        frames += len(block)
        watch(log.position, frames)


def _hand_on(batches: Iterable[tuple[str, pa.RecordBatch]], rows: Rows, summary: Summary) -> None:
    for name, batch in batches:
        summary.rows[name] += batch.num_rows
        rows.add(name, batch)


class _Span:
    """From the earliest to the latest time stamp."""

    def __init__(self) -> None:
        self._first, self._last = np.inf, -np.inf

    def add(self, block: FrameBlock) -> None:
        """Take the frames of a block into account."""
        self._first = min(self._first, float(np.fmin.reduce(block.timestamp)))
        self._last = max(self._last, float(np.fmax.reduce(block.timestamp)))

    @property
    def seconds(self) -> float:
        """How long it is; 0 without frames."""
        return max(0.0, self._last - self._first)
