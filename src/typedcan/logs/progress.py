"""How far a conversion is: a line on a terminal, with rate and time left."""

from __future__ import annotations

import time
from typing import TextIO

from typedcan.shell.progress import StatusLine

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
        self._line = StatusLine(stream)
        self._start = time.monotonic()

    def update(self, position: int, frames: int) -> None:
        """So many bytes are read, and so many frames."""
        seconds = time.monotonic() - self._start
        self._line.draw(lambda: bar(position, self._total, frames, seconds))

    def clear(self) -> None:
        """Take the line away."""
        self._line.clear()


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
