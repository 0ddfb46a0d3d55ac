"""A log, or the part of it between two moments, with its place in time.

Files of CANoe and PCAN-View say when they begin by the clock on the wall of the computer that
recorded them, others by UTC. Where it matters, ``recorded_in`` says which zone's clock it was.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import UTC, datetime, tzinfo
from pathlib import Path
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError

import numpy as np

from typedcan.logs.frames import FrameBlock
from typedcan.logs.read import BLOCK_SIZE, Damage, LogSource, open_log
from typedcan.logs.read.blocks import rows_of
from typedcan.logs.read.source import Start
from typedcan.model.errors import TypedcanError

_RELATIVE = 1e8
"""Time stamps below, the spring of 1973, count from the begin of a recording."""


class TimeError(TypedcanError, ValueError):
    """A time is none, or does not fit the log."""


@dataclass(frozen=True, slots=True)
class Moment:
    """Seconds since the log's first frame, or a date: without a zone it is that of the recorder."""

    seconds: float = 0.0
    date: datetime | None = None


@dataclass(frozen=True, slots=True)
class Window:
    """Which part of a log is wanted: from start to end, both included.

    ``recorded_in`` is the zone of the recorder's clock, such as ``Asia/Shanghai``; None: that of
    this computer.
    """

    start: Moment | None = None
    end: Moment | None = None
    recorded_in: str | None = None

    @property
    def is_open(self) -> bool:
        """Whether all of a log is wanted."""
        return self.start is None and self.end is None


ALL = Window()


def window_of(start: str | None, end: str | None, recorded_in: str | None) -> Window:
    """The window that a person gives; raises `TimeError`."""
    if recorded_in:
        zone_of(recorded_in)
    return Window(
        start=None if start is None else moment(start),
        end=None if end is None else moment(end),
        recorded_in=recorded_in,
    )


def moment(text: str) -> Moment:
    """A moment from seconds, or from a date and time in ISO 8601; raises `TimeError`."""
    try:
        seconds = float(text)
    except ValueError:
        try:
            return Moment(date=datetime.fromisoformat(text))
        except ValueError:
            seconds = math.nan
    if not math.isfinite(seconds):
        raise TimeError(f"expected seconds or a date like 2025-06-30T14:05:00, not {text!r}")
    return Moment(seconds)


def zone_of(name: str | None) -> tzinfo | None:
    """The zone of that name, None for this computer's; raises `TimeError`."""
    if name is None:
        return None
    if name.upper() in ("UTC", "Z"):
        return UTC
    try:
        return ZoneInfo(name)
    except (ZoneInfoNotFoundError, ValueError, OSError):
        raise TimeError(f"there is no time zone {name!r}; Asia/Shanghai and UTC are some") from None


def _since_1970(date: datetime, zone: tzinfo | None) -> float:
    """Of a date without a zone, that of this computer where ``zone`` is None."""
    try:
        return (date if date.tzinfo or zone is None else date.replace(tzinfo=zone)).timestamp()
    except (OverflowError, OSError, ValueError):
        raise TimeError(f"{date}: no time that this computer can reckon with") from None


@dataclass(frozen=True, slots=True)
class Clock:
    """How time stamps of a log are to be taken.

    Parameters
    ----------
    shift
        Seconds that are added to those that the file gives.
    origin
        What they count from then, in seconds since 1970; None: nobody knows.
    zone
        Of the recorder, None for this computer's; for dates without one.
    text
        When the log says it began, for people; empty where it does not.
    """

    shift: float
    origin: float | None
    zone: tzinfo | None
    text: str


def clock_of(start: Start | None, first: float, recorded_in: str | None) -> Clock:
    """The clock of a log that says it began so, and whose first frame has this time."""
    zone = zone_of(recorded_in)
    if start is None:
        return Clock(0.0, None if first < _RELATIVE else 0.0, zone, "")
    used = UTC if start.is_utc and recorded_in is None else zone
    seconds = _since_1970(start.wall, used)
    shown = f"{start.wall.isoformat(' ', 'milliseconds')} {_named(start, recorded_in)}"
    if start.counted:
        return Clock(0.0, seconds, used, shown)
    return Clock(seconds - _since_1970(start.wall, UTC), 0.0, used, shown)


def _named(start: Start, recorded_in: str | None) -> str:
    if recorded_in is not None:
        return recorded_in
    return "UTC" if start.is_utc else "by this computer's time zone; --recorded-in says another"


class LogPart(LogSource):
    """A log that is open: iterate once over the blocks of the part that is wanted.

    Parameters
    ----------
    path
        A log of any kind that `typedcan.logs.read.open_log` reads.
    block_size
        Frames in a block.
    window
        The part.
    later
        Seconds that are added to all times: where it is the second part of a drive.

    Raises
    ------
    LogError
        The log cannot be opened.
    TimeError
        While iterating: a date is given, and nobody knows what the log's times count from.
    """

    def __init__(
        self, path: Path, block_size: int = BLOCK_SIZE, window: Window = ALL, later: float = 0.0
    ) -> None:
        self.path = path
        self._log = open_log(path, block_size)
        self._window = window
        self._later = later
        self.clock = Clock(0.0, None, None, "")
        self.found = False
        """Whether a frame was in the window."""
        self.first, self.last = math.nan, math.nan
        """Times of the first frame of all, and of the latest that was read, as the blocks have
        them."""

    @property
    def damage(self) -> Damage | None:  # type: ignore[override]
        """As the log has it."""
        return self._log.damage

    @property
    def size(self) -> int:
        """Bytes of the file."""
        return self._log.size

    @property
    def position(self) -> int:
        """Bytes of the file that have been read so far."""
        return self._log.position

    @property
    def passed(self) -> Counter[str]:
        """As the log has it."""
        return self._log.passed

    def close(self) -> None:
        """Close the file."""
        self._log.close()

    def __iter__(self) -> Iterator[FrameBlock]:
        """The frames, in blocks that are never empty.

        Reading stops after a block whose frames are all later, unless none was in the window.
        """
        low, high = -math.inf, math.inf
        for given in self._log:
            block = given
            if math.isnan(self.first):
                self.clock = clock_of(
                    self._log.start, float(block.timestamp[0]), self._window.recorded_in
                )
                self.first = float(block.timestamp[0]) + self.clock.shift + self._later
                low, high = self._limits()
            shift = self.clock.shift + self._later
            if shift:
                block = replace(block, timestamp=block.timestamp + shift)
            self.last = np.fmax(self.last, float(block.timestamp.max()))
            if self._window.is_open:  # also what has a time that is no number
                self.found = True
                yield block
                continue
            kept = (block.timestamp >= low) & (block.timestamp <= high)
            if kept.all():
                self.found = True
                yield block
            elif kept.any():
                self.found = True
                yield rows_of(block, np.flatnonzero(kept))
            elif self.found and (block.timestamp > high).all():
                return

    def _limits(self) -> tuple[float, float]:
        start, end = self._window.start, self._window.end
        low = -math.inf if start is None else self._at(start)
        high = math.inf if end is None else self._at(end)
        return low, high

    def _at(self, limit: Moment) -> float:
        if limit.date is None:
            return self.first + limit.seconds
        if self.clock.origin is None:
            raise TimeError(
                f"{self.path}: the log's times count from its begin: give seconds, not a date"
            )
        return _since_1970(limit.date, self.clock.zone) - self.clock.origin + self._later

    def check_found(self) -> None:
        """Raise `TimeError` where a sound log has frames, and none of them is in the window."""
        spans = self.spans()
        if spans and not self.found and not self._window.is_open and self.damage is None:
            raise TimeError(f"{self.path}: no frame in this part; the log goes from {spans}")

    def spans(self) -> str:
        """From when to when the log goes, for people; empty where it has no frame."""
        if math.isnan(self.first):
            return ""
        return f"{self._said(self.first)} to {self._said(self.last)}"

    def _said(self, time: float) -> str:
        if self.clock.origin is None:
            return f"{time - self.first:.3f} s"
        date = datetime.fromtimestamp(self.clock.origin + time - self._later, UTC)
        local = date.astimezone(self.clock.zone)
        return f"{local.isoformat(' ', 'milliseconds')}"
