"""How regularly each message came, for the plots of a report."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.chunk import Chunk
from swapcan.conform.measure.spread import Spread
from swapcan.conform.measure.steps import StepMeter, Steps
from typedcan.wire.message import Message

COLUMNS = 600
"""Spans that a log is cut into for a plot."""

_SHORTEST_SPAN = 1 / 16
"""Seconds; doubled as often as the log's length asks for, which loses no digits."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Periods:
    """How regularly a message came.

    Steps are measured as `swapcan.conform.measure.steps` says: not across a silence of the node,
    nor from one request to the next.

    Parameters
    ----------
    message
        Its name.
    period
        What the standard prints, in seconds.
    frames
        How many came.
    mean, deviation, shortest, longest
        Seconds between two frames that carry the same; NaN where there are no two.
    time, low, high
        The middles of up to `COLUMNS` spans of equal length, in seconds since the log's begin,
        and the shortest and longest step that ended in each; spans without are left out.
    """

    message: str
    period: float
    frames: int
    mean: float
    deviation: float
    shortest: float
    longest: float
    time: NDArray[np.float64]
    low: NDArray[np.float64]
    high: NDArray[np.float64]


class PeriodMeter:
    """Measures the steps between the frames of one log."""

    def __init__(self) -> None:
        self._meter = StepMeter()
        self._spread = dict.fromkeys(PROTOCOL.messages, Spread())
        self._spans: dict[type[Message], _Spans] = {}

    def take(self, chunk: Chunk) -> None:
        """Measure the next frames."""
        for message, steps in self._meter.take(chunk).steps.items():
            self._spread[message] += steps.spread
            if message not in self._spans:
                self._spans[message] = _Spans()
            if len(steps):
                self._spans[message].take(steps)

    def finish(self, end: float) -> tuple[Periods, ...]:  # noqa: ARG002
        """One per message that has a period and came, in the standard's order."""
        return tuple(
            self._periods(message, message.PERIOD, self._spans[message])
            for message in PROTOCOL.messages
            if message.PERIOD and message in self._spans
        )

    def _periods(self, message: type[Message], period: float, spans: _Spans) -> Periods:
        spread = self._spread[message]
        time, low, high = spans.columns()
        return Periods(
            message=message.NAME,
            period=period,
            frames=self._meter.messages[message].frames,
            mean=spread.mean,
            deviation=spread.deviation,
            shortest=spread.shortest if spread.count else math.nan,
            longest=spread.longest if spread.count else math.nan,
            time=time,
            low=low,
            high=high,
        )


class _Spans:
    """The shortest and longest step in each of at most twice `COLUMNS` spans.

    When the log outgrows them, each two of them become one of twice the length.
    """

    def __init__(self) -> None:
        self._span = _SHORTEST_SPAN
        self._low: NDArray[np.float64] = np.full(2 * COLUMNS, np.inf)
        self._high: NDArray[np.float64] = np.full(2 * COLUMNS, -np.inf)

    def take(self, steps: Steps) -> None:
        """Note steps, one at least."""
        while steps.time.max() >= len(self._low) * self._span:
            self._double()
        # Most steps in a row end in the same span: first the extremes of each such run.
        places = np.maximum(steps.time / self._span, 0).astype(np.int64)
        runs = np.flatnonzero(np.diff(places, prepend=-1))
        where = places[runs]
        np.minimum.at(self._low, where, np.minimum.reduceat(steps.length, runs))
        np.maximum.at(self._high, where, np.maximum.reduceat(steps.length, runs))

    def columns(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """The middles of the spans with steps, at most `COLUMNS`, and their extremes."""
        while np.isfinite(self._low[COLUMNS:]).any():
            self._double()
        some = np.flatnonzero(np.isfinite(self._low))
        time: NDArray[np.float64] = (some + 0.5) * np.float64(self._span)
        return time, self._low[some], self._high[some]

    def _double(self) -> None:
        self._span *= 2
        for array, merge, empty in (
            (self._low, np.minimum, np.inf),
            (self._high, np.maximum, -np.inf),
        ):
            half = merge(array[0::2], array[1::2])
            array[: len(half)] = half
            array[len(half) :] = empty
