"""Text logs: lines of the same shape are read together, all others by python-can's own reader."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Protocol

import can
import numpy as np
from numpy.typing import NDArray

from typedcan.logs.frames import FrameBlock
from typedcan.logs.read.alike import groups_alike
from typedcan.logs.read.bad_lines import BadLines
from typedcan.logs.read.blocks import Channels, reblock
from typedcan.logs.read.columns import Columns, channel_of, payload_length
from typedcan.logs.read.lines import LONGEST_LINE, LineBatch, TextLines
from typedcan.logs.read.one_by_one import OneByOne
from typedcan.logs.read.payload import Payload
from typedcan.logs.read.shape import LONGEST_SHAPE, Shape
from typedcan.logs.read.silence import silenced
from typedcan.logs.read.source import Damage, LogSource

_TOGETHER = 16_384
"""Lines that are read at once: enough to make calls cheap, few enough to stay in the cache."""

_FEW = 16
_FEW_PER_COLUMN = 0.25
"""So many lines, more where they are long, python-can has read before a shape is made of them."""

_POOR_SHAPES = 4
"""Shapes of few lines in a row, after which python-can is quicker."""

_GARBAGE = re.compile(rb"[\x00-\x08\x0a-\x1f\x7f]")
NOT_A_FRAME = (ArithmeticError, LookupError, TypeError, ValueError)
"""What python-can's readers raise on lines that hold no frame."""


class TextFormat(Protocol):
    """What is special about one format."""

    name: str
    """For messages."""

    payload: Payload
    """How it writes payloads."""

    time_unit: int
    """What times are divided by to make seconds."""

    lines: OneByOne
    """python-can's reader."""

    warnings: list[str]
    """What it warns of."""

    @property
    def pattern(self) -> re.Pattern[bytes] | None:
        """The regular line of a frame with its line feed; `Shape` says which groups it has."""
        ...

    @property
    def origin(self) -> float:
        """What is added to times, in seconds."""
        ...

    def is_header(self, line: bytes) -> bool:
        """Whether the line, the first or behind header lines, belongs to the header.

        Raises one of `NOT_A_FRAME` where it does and is damaged.
        """
        ...

    def read(self, line: str) -> can.Message | None:
        """What python-can makes of a line; None where it holds something else than a frame.

        Raises one of `NOT_A_FRAME` where a frame should be and is none.
        """
        ...


class TextSource(LogSource):
    """A text log, also one that gzip compressed.

    A line that should be a frame and is none is left out, and the reading goes on behind it:
    ``damage`` names the first one and says how many there are.

    Parameters
    ----------
    path
        The log.
    block_size
        Frames in a block.
    form
        Its format.

    Raises
    ------
    OSError
        The file cannot be opened.
    """

    def __init__(self, path: Path, block_size: int, form: TextFormat) -> None:
        self.path = path
        self.damage: Damage | None = None
        self._block_size = block_size
        self._form = form
        self._lines = TextLines(path, block_size)
        self._channels = Channels()
        self._in_header = True
        self._bad = BadLines(form.name)

    @property
    def size(self) -> int:
        """Bytes of the file."""
        return self._lines.size

    @property
    def position(self) -> int:
        """Bytes of the file that have been read so far."""
        return self._lines.position

    def close(self) -> None:
        """Close the file."""
        self._lines.close()

    def __iter__(self) -> Iterator[FrameBlock]:
        """The frames, in blocks."""
        return reblock(self._blocks(), self._block_size)

    def _blocks(self) -> Iterator[FrameBlock]:
        lines = 0
        for batch in self._lines:
            yield self._block(batch)
            lines += len(batch.ends)
        self.damage = self._bad.damage(self.path, self._lines.problem, lines)

    def _block(self, batch: LineBatch) -> FrameBlock:
        with silenced(self._form.lines.logger) as self._form.warnings:
            return self._frames(batch)

    def _frames(self, batch: LineBatch) -> FrameBlock:
        columns = Columns(len(batch.ends))
        first = self._header(batch)
        last = len(batch.ends) - batch.unfinished
        origins = np.full(len(batch.ends), self._form.origin)
        slow = [*self._regular(batch, columns, first, last), *range(max(first, last), len(origins))]
        added = columns.filled.copy()
        single = []
        for row in sorted(slow):
            frame = self._irregular(batch, row)
            if frame is not None:
                single.append((row, *frame))
            if self._form.origin != origins[row]:
                origins[row:] = self._form.origin
        columns.put_frames(single)
        if origins.any():
            columns.timestamp[added] += origins[added]
        if batch.unfinished:
            self._check_end(batch, columns)
        return columns.block(self._channels.known)

    def _header(self, batch: LineBatch) -> int:
        """Pass over the lines of the header; returns how many there are in this batch."""
        for row in range(len(batch.ends)):
            if not self._in_header:
                return row
            try:
                self._in_header = self._form.is_header(batch.line(row))
            except NOT_A_FRAME:
                self._bad.add(batch, row)
            if not self._in_header:
                return row
        return len(batch.ends)

    def _regular(self, batch: LineBatch, columns: Columns, first: int, last: int) -> Iterator[int]:
        """Read the lines that are as most are; which others there are is returned."""
        lengths = (batch.ends - batch.starts)[first:last]
        if self._form.pattern is None or sys.byteorder != "little":
            lengths[:] = LONGEST_SHAPE
        lengths = lengths.clip(max=LONGEST_SHAPE).astype(np.uint16)
        order = np.argsort(lengths, kind="stable")
        for rows in np.split(order, np.flatnonzero(np.diff(lengths[order])) + 1):
            if not len(rows) or lengths[rows[0]] == LONGEST_SHAPE:
                yield from (rows + first).tolist()
            else:
                yield from self._of_one_length(batch, columns, rows + first)

    def _of_one_length(
        self, batch: LineBatch, columns: Columns, rows: NDArray[np.int64], *, mixed: bool = True
    ) -> Iterator[int]:
        """Read what is regular of some lines of one length; the others are returned."""
        poor = 0
        few = _FEW + _FEW_PER_COLUMN * self._length(batch, rows)
        while len(rows) >= few and poor < _POOR_SHAPES:
            found = self._shape(batch, int(rows[0]))
            if found is not None:
                good = self._read(batch, columns, rows, *found)
                if good[0]:
                    count = np.count_nonzero(good)
                    poor = poor + 1 if count < few else 0
                    rows = rows[~good]
                    if mixed and len(rows) > count:
                        for group in self._alike(batch, rows):
                            yield from self._of_one_length(batch, columns, group, mixed=False)
                        return
                    continue
            yield int(rows[0])
            rows = rows[1:]
        yield from rows.tolist()

    @staticmethod
    def _length(batch: LineBatch, rows: NDArray[np.int64]) -> int:
        return int(batch.ends[rows[0]] - batch.starts[rows[0]])

    def _alike(self, batch: LineBatch, rows: NDArray[np.int64]) -> Iterator[NDArray[np.int64]]:
        for group in groups_alike(batch.text, batch.starts[rows], self._length(batch, rows)):
            yield rows[group]

    def _shape(self, batch: LineBatch, row: int) -> tuple[Shape, can.Message, int] | None:
        """The shape of a line, if it is a regular one, its frame and the channel's index."""
        pattern = self._form.pattern
        line = batch.text[batch.starts[row] : batch.ends[row] + 1].tobytes()
        match = pattern and pattern.fullmatch(line)
        if not match or _GARBAGE.search(line.rstrip()):
            return None
        try:
            frame = self._form.read(line.decode().rstrip("\r\n"))
            if frame is None or frame.is_remote_frame or frame.is_error_frame:
                return None
            length = payload_length(frame)
            channel = self._channels.index(channel_of(frame))
        except NOT_A_FRAME:
            return None
        if len(match["data"]) < self._form.payload.width(length):
            return None
        return Shape(match, self._form.payload, length, self._form.time_unit), frame, channel

    def _read(
        self,
        batch: LineBatch,
        columns: Columns,
        rows: NDArray[np.int64],
        shape: Shape,
        frame: can.Message,
        channel: int,
    ) -> NDArray[np.bool_]:
        """Read those of the lines that have the shape; ``frame`` is in the first one."""
        good = np.empty(len(rows), np.bool_)
        for first in range(0, len(rows), _TOGETHER):
            some = rows[first : first + _TOGETHER]
            values = shape.read(batch.text, batch.starts[some])
            if not first and not values.begin_with(frame, self._form.origin):
                good[:] = False
                break
            good[first : first + _TOGETHER] = values.good
            if not values.good.all():
                some, values = some[values.good], values.kept()
            columns.put(some, values)
            columns.put_alike(some, frame, channel, shape.length)
        return good

    def _irregular(self, batch: LineBatch, row: int) -> tuple[can.Message, int] | None:
        """Read any line, as python-can does; returns its frame, if any, and the channel's index."""
        line = batch.line(row)
        if not line.strip():
            return None
        try:
            if len(line) > LONGEST_LINE or _GARBAGE.search(line):
                raise ValueError("no text")
            frame = self._form.read(line.decode(errors="surrogateescape"))
            if frame is not None:
                payload_length(frame)
                return frame, self._channels.index(channel_of(frame))
            if batch.unfinished and row == len(batch.ends) - 1 and line.lstrip()[:1].isdigit():
                raise ValueError("cut off")
        except NOT_A_FRAME:
            self._bad.add(batch, row)
        return None

    def _check_end(self, batch: LineBatch, columns: Columns) -> None:
        """A last line without end is cut off if it is shorter than others of its identifier."""
        if not columns.filled[-1]:
            return
        alike = columns.filled & (columns.frame_id == columns.frame_id[-1])
        lengths = [len(batch.line(int(row))) for row in np.flatnonzero(alike)]
        if len(lengths) > 1 and lengths[-1] < min(lengths[:-1]):
            columns.filled[-1] = False
            self._bad.add(batch, len(batch.ends) - 1)
