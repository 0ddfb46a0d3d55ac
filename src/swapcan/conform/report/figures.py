"""Numbers and times as texts, the same in every report."""

from __future__ import annotations

import math
from datetime import datetime, timedelta, timezone

_ABSOLUTE = 1e8
"""Time stamps from here on count from 1970."""

_EPOCH = datetime(1970, 1, 1, tzinfo=timezone.utc)  # noqa: UP017  (placeholder)


def count(number: int) -> str:
    """A whole number, its thousands apart."""
    return f"{number:,}"
