"""The part of a log that is asked for, by time."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from datetime import datetime

import numpy as np

from typedcan.logs.frames import FrameBlock
from typedcan.logs.read.blocks import rows_of
from typedcan.model.errors import TypedcanError

_RELATIVE = 1e8
"""Time stamps below, the spring of 1973, count from the begin of a recording."""


class TimeError(TypedcanError, ValueError):
    """A time is none, or does not fit the log."""


@dataclass(frozen=True, slots=True)
class Moment:
    """Seconds, since the log's begin or, where ``absolute``, since 1970."""

    seconds: float
    absolute: bool


def moment(text: str) -> Moment:
    """A moment from seconds, or from a date and time in ISO 8601, local unless it has an offset.

    Raises
    ------
    TimeError
        It is neither.
    """
    try:
        seconds = float(text)
    except ValueError:
        try:
            return Moment(datetime.fromisoformat(text).timestamp(), absolute=True)
        except (ValueError, OverflowError, OSError):
            seconds = math.nan
    if not math.isfinite(seconds):
        raise TimeError(f"expected seconds or a date like 2025-06-30T14:05:00, not {text!r}")
    return Moment(seconds, absolute=False)


def within(
    blocks: Iterable[FrameBlock], start: Moment | None, end: Moment | None
) -> Iterator[FrameBlock]:
    """The frames from start to end, both included; None: from the first, to the last.

    Reading stops after a block whose frames are all later.

    Raises
    ------
    TimeError
        A date is given, and the log's times count from its begin.
    """
    if start is None and end is None:
        yield from blocks
        return
    first: float | None = None
    for block in blocks:
        if first is None:
            first = float(block.timestamp[0])
            if first < _RELATIVE and any(limit and limit.absolute for limit in (start, end)):
                raise TimeError("the log's times count from its begin: give seconds, not a date")
        low = -np.inf if start is None else _since_1970(start, first)
        high = np.inf if end is None else _since_1970(end, first)
        kept = (block.timestamp >= low) & (block.timestamp <= high)
        if kept.all():
            yield block
        elif kept.any():
            yield rows_of(block, np.flatnonzero(kept))
        elif (block.timestamp > high).all():
            return


def _since_1970(limit: Moment, first: float) -> float:
    return limit.seconds if limit.absolute else first + limit.seconds
