"""Several logs of one drive: in which order they come, and how their times go on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from math import isnan
from pathlib import Path

from typedcan.logs.part import LogPart, TimeError, Window

_RESOLUTION = 1e-3
"""Seconds: dates in headers have milliseconds, so that parts may seem to overlap by one."""

Part = tuple[Path, float]
"""A log, and the seconds that are added to its times."""


def parts_of(logs: Sequence[Path], window: Window) -> list[Part]:
    """The logs in the order in which they were recorded, where all of them say when.

    Times that count from the begin of their log go on from the begin of the first one. Logs that
    do not say when they begin stay in the order given.
    """
    if len(logs) < 2:
        return [(log, 0.0) for log in logs]
    begins = [_begin(log, window) for log in logs]
    known = [begin for begin in begins if begin is not None]
    if len(known) < len(logs):
        return [(log, 0.0) for log in logs]
    order = sorted(zip(known, logs, strict=True), key=lambda each: sum(each[0]))
    zero = min(origin for (origin, _), _ in order)
    return [(log, origin - zero) for (origin, _), log in order]


def _begin(log: Path, window: Window) -> tuple[float, float] | None:
    """What the times of a log count from, and that of its first frame; None: nobody knows."""
    with LogPart(log, 1, replace(window, start=None, end=None)) as part:
        for _ in part:
            break
        origin = part.clock.origin
        return None if origin is None or isnan(part.first) else (origin, part.first)


def check_order(spans: Sequence[tuple[Path, float, float]]) -> None:
    """Raise `TimeError` where a log begins before the one before it ends."""
    sound = [span for span in spans if not isnan(span[1])]
    for (before, _, last), (log, first, _) in pairwise(sound):
        if first < last - _RESOLUTION:
            raise TimeError(
                f"{log}: begins {last - first:.3f} s before {before.name} ends, so they are not"
                " parts of one drive in this order: convert them apart"
            )
