"""Text logs: lines of the same shape are read together, all others one by one."""

from __future__ import annotations

import re
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.frames import FrameBlock
from typedcan.logs.read.alike import groups_alike
from typedcan.logs.read.bad_lines import BadLines
from typedcan.logs.read.blocks import Channels, reblock
from typedcan.logs.read.columns import Columns
from typedcan.logs.read.frame import ERROR, REMOTE, Frame, Other
from typedcan.logs.read.lines import LONGEST_LINE, LineBatch, TextLines
from typedcan.logs.read.shape import LONGEST_SHAPE, Shape
from typedcan.logs.read.source import Damage, LogSource
from typedcan.logs.read.text_format import NOT_A_FRAME, TextFormat

_TOGETHER = 16_384
"""Lines that are read at once: enough to make calls cheap, few enough to stay in the cache."""

_FEW = 16
_FEW_PER_COLUMN = 0.25
"""So many lines, more where they are long, are read one by one before a shape is made of them."""

_POOR_SHAPES = 4
"""Shapes of few lines in a row, after which reading one by one is quicker."""

_GARBAGE = re.compile(rb"[\x00-\x08\x0a-\x1f\x7f]")


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
        self._passed: Counter[str] = Counter()

    @property
    def passed(self) -> Counter[str]:
        """What in the file is no frame on the bus, by kind."""
        return self._passed

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
            block = self._frames(batch)
            self.start = self._form.start
            yield block
            lines += len(batch.ends)
        self.damage = self._bad.damage(self.path, self._lines.problem, lines)

    def _frames(self, batch: LineBatch) -> FrameBlock:
        columns = Columns(len(batch.ends))
        first = self._header(batch)
        last = len(batch.ends) - batch.unfinished
        slow = [*self._regular(batch, columns, first, last)]
        slow += range(max(first, last), len(batch.ends))
        single: list[tuple[int, Frame, int]] = []
        others: list[tuple[int, Other]] = []
        for row in sorted(slow):
            self._irregular(batch, row, single, others)
        columns.put_frames(single)
        if batch.unfinished:
            self._check_end(batch, columns)
        self._passed.update(other.kind for _, other in others if other.kind)
        self._form.reckon(columns, others)
        return columns.block(self._channels.known)

    def _header(self, batch: LineBatch) -> int:
        """Pass over the lines of the header; returns how many there are in this batch."""
        for row in range(len(batch.ends)):
            if not self._in_header:
                return row
            try:
                self._in_header = self._form.is_header(_text(batch.line(row)))
            except NOT_A_FRAME:
                self._bad.add(batch, row)
            if not self._in_header:
                return row
        return len(batch.ends)

    def _regular(self, batch: LineBatch, columns: Columns, first: int, last: int) -> Iterator[int]:
        """Read the lines that are as most are; which others there are is returned."""
        lengths = (batch.ends - batch.starts)[first:last]
        if not self._form.patterns or sys.byteorder != "little":
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

    def _shape(self, batch: LineBatch, row: int) -> tuple[Shape, Frame, int] | None:
        """The shape of a line, if it is a regular one, its frame and the channel's index."""
        form = self._form
        line = batch.text[batch.starts[row] : batch.ends[row] + 1].tobytes()
        if _GARBAGE.search(line.rstrip()):
            return None
        match = next(filter(None, (pattern.fullmatch(line) for pattern in form.patterns)), None)
        if match is None:
            return None
        try:
            frame = form.read(line.decode().rstrip("\r\n"))
            if isinstance(frame, Other) or frame.flags & (REMOTE | ERROR):
                return None
            channel = self._channels.index(frame.channel)
        except NOT_A_FRAME:
            return None
        held, needed = len(match["data"]), form.payload.width(frame.length)
        if held < needed or (held > needed and "skip" in match.re.groupindex):
            return None
        return Shape(match, form.payload, frame.length, form.time_unit), frame, channel

    def _read(
        self,
        batch: LineBatch,
        columns: Columns,
        rows: NDArray[np.int64],
        shape: Shape,
        frame: Frame,
        channel: int,
    ) -> NDArray[np.bool_]:
        """Read those of the lines that have the shape; ``frame`` is in the first one."""
        good = np.empty(len(rows), np.bool_)
        for first in range(0, len(rows), _TOGETHER):
            some = rows[first : first + _TOGETHER]
            values = shape.read(batch.text, batch.starts[some])
            if not first and not values.begin_with(frame):
                good[:] = False
                break
            good[first : first + _TOGETHER] = values.good
            if not values.good.all():
                some, values = some[values.good], values.kept()
            columns.put(some, values)
            columns.put_alike(some, frame, channel)
        return good

    def _irregular(
        self,
        batch: LineBatch,
        row: int,
        frames: list[tuple[int, Frame, int]],
        others: list[tuple[int, Other]],
    ) -> None:
        """Read any line; what it holds is added to the frames, or to what else there is."""
        line = batch.line(row)
        if not line.strip():
            return
        try:
            found = self._form.read(_text(line).decode(errors="surrogateescape"))
            if isinstance(found, Frame):
                frames.append((row, found, self._channels.index(found.channel)))
                return
            if batch.unfinished and row == len(batch.ends) - 1 and line.lstrip()[:1].isdigit():
                raise ValueError("cut off")
        except NOT_A_FRAME:
            self._bad.add(batch, row)
            found = Other("", self._form.time_of(line))
        others.append((row, found))

    def _check_end(self, batch: LineBatch, columns: Columns) -> None:
        """A last line without end is cut off if it is shorter than others of its identifier."""
        if not columns.filled[-1]:
            return
        alike = columns.filled & (columns.frame_id == columns.frame_id[-1])
        lengths = [len(batch.line(int(row))) for row in np.flatnonzero(alike)]
        if len(lengths) > 1 and lengths[-1] < min(lengths[:-1]):
            columns.filled[-1] = False
            self._bad.add(batch, len(batch.ends) - 1)


def _text(line: bytes) -> bytes:
    """The line; raises `ValueError` where it is none of a text."""
    if len(line) > LONGEST_LINE or _GARBAGE.search(line):
        raise ValueError("no text")
    return line
