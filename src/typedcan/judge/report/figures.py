"""Numbers and times as texts, the same in every report."""

from __future__ import annotations

import math
from datetime import UTC, datetime, timedelta

_ABSOLUTE = 1e8
"""Time stamps from here on count from 1970."""

_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)


def count(number: int) -> str:
    """A whole number, its thousands apart."""
    return f"{number:,}"


def seconds(time: float) -> str:
    """A time since the log's begin, to the millisecond."""
    return "–" if math.isnan(time) else f"{time:,.3f} s"


def milliseconds(time: float) -> str:
    """A short time, given in seconds; to a tenth or hundredth of a millisecond."""
    if math.isnan(time):
        return "–"
    digits = 1 if abs(time) >= 0.1 else 2
    return f"{time * 1000:,.{digits}f}".rstrip("0").rstrip(".") + " ms"


def share(part: float) -> str:
    """A share in percent."""
    return "–" if math.isnan(part) else f"{part * 100:.1f} %"


def number(value: float) -> str:
    """A number without noise: at most six significant digits, no exponent where it is whole."""
    if math.isnan(value):
        return "–"
    if value == round(value) and abs(value) < 1e15:
        return f"{round(value):,}"
    return f"{value:.6g}"


def utc(time: float) -> str:
    """A time stamp in ISO 8601, to the microsecond; empty where it does not count from 1970."""
    if not time >= _ABSOLUTE:
        return ""
    try:
        moment = _EPOCH + timedelta(microseconds=round(time * 1e6))
    except OverflowError:
        return ""
    return moment.strftime("%Y-%m-%dT%H:%M:%S.%fZ")
