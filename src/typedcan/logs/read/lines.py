"""The lines of a text log, in batches, with memory that does not grow with the file."""

from __future__ import annotations

import codecs
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.read.gunzip import GZIP, BrokenGzip, gunzip
from typedcan.model.errors import one_line

PADDING = 1024
"""Bytes that may be read beyond the end of any line."""

LONGEST_LINE = 65_536
"""Bytes; what is longer is no line of a log, and is cut off after one byte more."""

_SMALLEST_BUFFER = 4 * LONGEST_LINE
_LARGEST_BUFFER = 1 << 22
_PIECE = 1 << 18
_LF, _CR = b"\n\r"
_UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
_MARKS = (*_UTF_16, codecs.BOM_UTF8)


@dataclass(frozen=True, slots=True)
class LineBatch:
    """Lines in a buffer that the next batch overwrites.

    Parameters
    ----------
    text
        The buffer, with `PADDING` behind the last line.
    starts, ends
        Where each line begins, and where its line feed is.
    number
        The number of the first line, from 1.
    unfinished
        The last line has no line feed: the file ends there.
    """

    text: NDArray[np.uint8]
    starts: NDArray[np.int64]
    ends: NDArray[np.int64]
    number: int
    unfinished: bool

    def line(self, index: int) -> bytes:
        """A line without what ends it."""
        return self.text[self.starts[index] : self.ends[index]].tobytes().removesuffix(b"\r")


class TextLines:
    """A file's lines, also of one that gzip compressed; line feed, CR LF and CR end a line.

    Parameters
    ----------
    path
        The file.
    batch
        Lines in a batch at most.

    Raises
    ------
    OSError
        The file cannot be opened.
    """

    problem: str | None = None
    """What ended the reading too early."""

    def __init__(self, path: Path, batch: int) -> None:
        self._file = path.open("rb", buffering=0)
        self.size = path.stat().st_size
        head = self._file.read(len(codecs.BOM_UTF8))
        self._file.seek(0)
        self._pieces = None
        if head.startswith(GZIP):
            self._pieces = as_utf_8(gunzip(self._file))
        elif head.startswith(_MARKS):
            self._pieces = as_utf_8(iter(partial(self._file.read, _PIECE), b""))
        self._piece = memoryview(b"")
        self._batch = batch
        self._capacity = min(max(64 * batch, _SMALLEST_BUFFER), _LARGEST_BUFFER)
        self._buffer = bytearray(self._capacity + PADDING)
        self._text = np.frombuffer(self._buffer, dtype=np.uint8)

    @property
    def position(self) -> int:
        """Bytes of the file that have been read."""
        return self.size if self._file.closed else min(self._file.tell(), self.size)

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def __iter__(self) -> Iterator[LineBatch]:
        """The batches; each is valid until the next."""
        number, filled, used, skipping, ended = 1, 0, 0, False, False
        while not ended:
            filled = self._fill(filled)
            ended = filled < self._capacity
            filled, ends = self._line_ends(filled, ended=ended)
            if skipping:  # the rest of a line that is too long
                skipping = not len(ends)
                first = filled if skipping else int(ends[0]) + 1
                filled, ends = self._drop(first, filled), ends[1:] - first
            if not len(ends) and filled == self._capacity:
                skipping, ends = True, np.array([LONGEST_LINE + 1])
            unfinished = ended and self.problem is None and filled > _after(ends)
            if unfinished:
                ends = np.append(ends, filled)
            for batch in self._batches(ends, number, unfinished=unfinished, ended=ended):
                yield batch
                number += len(batch.ends)
                used = _after(batch.ends)
            filled = self._drop(filled if skipping or ended else used, filled)

    def _fill(self, filled: int) -> int:
        """Read behind what is there, until the buffer is full or the file has no more."""
        view = memoryview(self._buffer)
        try:
            while filled < self._capacity:
                count = self._read_into(view[filled : self._capacity])
                if not count:
                    break
                filled += count
        except (BrokenGzip, OSError) as error:
            self.problem = one_line(error)
        return filled

    def _read_into(self, room: memoryview) -> int:
        if self._pieces is None:
            return self._file.readinto(room) or 0
        while not self._piece:
            piece = next(self._pieces, None)
            if piece is None:
                return 0
            self._piece = memoryview(piece)
        count = min(len(room), len(self._piece))
        room[:count] = self._piece[:count]
        self._piece = self._piece[count:]
        return count

    def _line_ends(self, filled: int, *, ended: bool) -> tuple[int, NDArray[np.int64]]:
        """How many bytes there are, and where the line feeds are; a lone CR becomes one."""
        ends = np.flatnonzero(self._text[:filled] == _LF)
        if self._buffer.find(b"\r", 0, filled) < 0:
            return filled, ends
        held = not ended and self._buffer[filled - 1] == _CR  # its line feed may be still to come
        returns = self._buffer.count(b"\r", 0, filled) - held
        before = ends[1:] if len(ends) and ends[0] == 0 else ends
        if returns == np.count_nonzero(self._text[before - 1] == _CR):
            return filled, ends
        text = self._buffer[: filled - held].replace(b"\r\n", b"\n").replace(b"\r", b"\n")
        text += b"\r" * held
        self._buffer[: len(text)] = text
        return len(text), np.flatnonzero(self._text[: len(text)] == _LF)

    def _drop(self, first: int, filled: int) -> int:
        """Move what is left to the front of the buffer; returns how much that is."""
        kept = filled - first
        self._text[:kept] = self._text[first:filled].copy()
        return kept

    def _batches(
        self, ends: NDArray[np.int64], number: int, *, unfinished: bool, ended: bool
    ) -> Iterator[LineBatch]:
        """Full batches, and the lines that are left if no more can join them."""
        starts = np.concatenate(([0], ends[:-1] + 1))
        for first in range(0, len(ends), self._batch):
            rows = slice(first, first + self._batch)
            last = first + self._batch >= len(ends)
            if last and first and not ended and len(ends) % self._batch:
                return
            yield LineBatch(
                self._text, starts[rows], ends[rows], number + first, unfinished and last
            )


def _after(ends: NDArray[np.int64]) -> int:
    return int(ends[-1]) + 1 if len(ends) else 0


def as_utf_8(pieces: Iterator[bytes]) -> Iterator[bytes]:
    """The same text without the mark that Windows puts before it, and as UTF-8 if it is UTF-16."""
    first = next(pieces, b"")
    while len(first) < len(codecs.BOM_UTF8) and (more := next(pieces, b"")):
        first += more
    if not first.startswith(_UTF_16):
        yield first.removeprefix(codecs.BOM_UTF8)
        yield from pieces
        return
    decoder = codecs.getincrementaldecoder("utf-16")(errors="replace")
    yield decoder.decode(first).encode(errors="replace")
    for piece in pieces:
        yield decoder.decode(piece).encode(errors="replace")
    yield decoder.decode(b"", final=True).encode(errors="replace")
