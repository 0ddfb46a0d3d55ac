"""What a signal says in place of a value."""

from __future__ import annotations

from enum import Enum


class SignalState(Enum):
    """What a signal says instead of a value."""

    INVALID = "Signal Invalid"
    ABNORMAL = "Abnormal"

    def __str__(self) -> str:
        return self.value
