"""A line on a terminal that says how far something is, drawn again and again in its place."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from contextlib import suppress
from typing import TextIO

from typedcan.shell.printing import printable

_INTERVAL = 0.2
"""Seconds from the start to the first drawing, and between two."""


class StatusLine:
    """The line; nothing is drawn where the stream is no terminal.

    Parameters
    ----------
    stream
        Where it is drawn; None: standard error.
    """

    def __init__(self, stream: TextIO | None = None) -> None:
        self._stream = stream or sys.stderr
        self._shown = bool(self._stream) and self._stream.isatty()
        self._next = time.monotonic() + _INTERVAL
        self._drawn = 0

    def draw(self, text: Callable[[], str]) -> None:
        """Draw what ``text`` gives, if it is time for that."""
        now = time.monotonic()
        if self._shown and now >= self._next:
            self._next = now + _INTERVAL
            self._put(printable(text()))

    def clear(self) -> None:
        """Take the line away."""
        if self._drawn:
            self._put("")
            self._put("")

    def _put(self, text: str) -> None:
        with suppress(OSError):  # the terminal may be gone
            self._stream.write("\r" + text.ljust(self._drawn))
            self._stream.flush()
        self._drawn = len(text)
