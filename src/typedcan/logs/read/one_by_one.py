"""python-can's readers of text logs, given one line at a time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Self, TextIO, cast

import can
from can.io.generic import TextIOMessageReader


class _NoMoreLines(Exception):
    """The reader passed over the line and wants another."""


class _Feed:
    """The file that a reader believes it has."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        """Those to come, the next one last."""

    def __iter__(self) -> Self:
        return self

    def __next__(self) -> str:
        if self.lines:
            return self.lines.pop()
        raise _NoMoreLines


class OneByOne:
    """Gives a reader of python-can lines.

    Parameters
    ----------
    reader
        Any reader of text logs. It keeps what it learns, such as the start time of an ASC log.
    before
        The lines that it wants to see before a frame.
    """

    def __init__(self, reader: TextIOMessageReader, *before: str) -> None:
        self.before = before
        self.logger = type(reader).__module__
        """The name of the logger that it uses."""
        self._feed = _Feed()
        self._reader = reader
        self._reader.file = cast("TextIO", self._feed)
        self._frames: Iterator[can.Message] | None = None

    def read(self, line: str) -> can.Message | None:
        """The frame in a line, if there is one; raises whatever the reader raises."""
        if self._frames is None:
            return self._next(iter(self._reader), *self.before, line)
        return self._next(self._frames, line)

    def first(self, *lines: str) -> can.Message | None:
        """The first frame in a log of these lines, if there is one; raises as `read`."""
        frame = self._next(iter(self._reader), *lines)
        self._frames = None
        return frame

    def _next(self, frames: Iterator[can.Message], *lines: str) -> can.Message | None:
        self._frames = None  # what raises is of no more use
        self._feed.lines[:] = lines[::-1]
        try:
            frame = next(frames)
        except _NoMoreLines:
            return None
        self._frames = frames
        return frame
