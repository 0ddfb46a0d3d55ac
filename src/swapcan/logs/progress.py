"""How far a conversion is: a line on a terminal, with rate and time left."""

from __future__ import annotations

import sys
import time
from typing import TextIO

_INTERVAL = 0.2
"""Seconds between two updates."""

_WIDTH = 24


class Progress:
    """A bar that is drawn again and again in one line; nothing where the stream is no terminal.

    Parameters
    ----------
    total
        Bytes of all logs.
    stream
        Where it is drawn; None: standard error.
    """

    def __init__(self, total: int, stream: TextIO | None = None) -> None:
        self._total = total
        self._stream = stream or sys.stderr
        self._shown = bool(self._stream) and self._stream.isatty()
        self._start = time.monotonic()
        self._next = self._start + _INTERVAL
        self._drawn = 0

    def update(self, position: int, frames: int) -> None:
        """So many bytes are read, and so many frames."""
        now = time.monotonic()
        if self._shown and now >= self._next:
            self._next = now + _INTERVAL
            self._draw(bar(position, self._total, frames, now - self._start))

    def clear(self) -> None:
        """Take the line away."""
        if self._drawn:
            self._draw("")
            self._stream.write("\r")
            self._stream.flush()
            self._drawn = 0

    def _draw(self, text: str) -> None:
        self._stream.write("\r" + text.ljust(self._drawn))
        self._stream.flush()
        self._drawn = len(text)


def bar(position: int, total: int, frames: int, seconds: float) -> str:
    """The line: share of the bytes, frames, frames a second, time left."""
    share = min(position / total, 1.0) if total else 1.0
    filled = round(share * _WIDTH)
    rate = frames / seconds if seconds else 0.0
    left = f", {_clock(seconds * (1 - share) / share)} left" if share else ""
    body = "#" * filled + "-" * (_WIDTH - filled)
    return f"[{body}] {share:4.0%}  {frames:,} frames, {rate:,.0f}/s{left}"


def _clock(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"
