"""What one message said last, beside each frame of another."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.series import Series, latest
from typedcan.judge.tolerance import LAST_KNOWN, Limits
from typedcan.wire.message import Message


def fresh_for(message: type[Message], limits: Limits) -> float:
    """Seconds for which a frame of a message counts; for ever where it has no period."""
    return math.inf if message.PERIOD is None else limits.limit(LAST_KNOWN) * message.PERIOD


class LastKnown:
    """The last frame of one message at each frame of another one.

    Parameters
    ----------
    of
        Of which message.
    at
        Beside which frames; what stands at the row of before means nothing.
    age
        Seconds for which a frame counts; None: as `fresh_for` has it.

    ``known`` says at which of them there is one that is fresh.
    """

    def __init__(self, of: Series, at: Series, age: float | None = None) -> None:
        rows = latest(of, at)
        self.known: NDArray[np.bool_] = rows >= 0
        self.rows = np.maximum(rows, 0)
        self._of = of
        if len(of):
            self.known &= at.time - of.time[self.rows] <= (of.lasts if age is None else age)

    def raw(self, field: str) -> NDArray[np.int64]:
        """The raw values of a field; they mean nothing where the message is not known."""
        return self._of.raw(field)[self.rows] if len(self._of) else np.zeros_like(self.rows)

    def value(self, field: str) -> NDArray[np.float64]:
        """The physical values, NaN where there is none or the message is not known."""
        values = np.full(len(self.rows), np.nan)
        if len(self._of):
            values[self.known] = self._of.value(field)[self.rows[self.known]]
        return values

    def is_code(self, field: str, code: int) -> NDArray[np.bool_]:
        """Where the message is known and a field has a code."""
        is_so: NDArray[np.bool_] = self.known & (self.raw(field) == code)
        return is_so
