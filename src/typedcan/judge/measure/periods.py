"""How regularly each message came, for the plots of a report."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.measure.presence import Presence
from typedcan.judge.measure.spread import Spread
from typedcan.judge.measure.steps import Steps, Timing
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

COLUMNS = 600
"""Spans that a log is cut into for a plot."""

_SHORTEST_SPAN = 1 / 16
"""Seconds; doubled as often as the log's length asks for, which loses no digits."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Periods:
    """How regularly a message came.

    Steps are measured as `typedcan.judge.measure.steps` says: not across a silence of the node,
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

    def __init__(self, protocol: Protocol) -> None:
        self._messages = protocol.messages
        self._whole: dict[type[Message], _Measured] = {}
        self._each: dict[type[Message], _Measured] = {}

    def feed(self, timing: Timing) -> None:
        """Note the steps of the next frames."""
        for measured, found in ((self._whole, timing.steps), (self._each, timing.each)):
            for message, steps in found.items():
                if message not in measured:
                    measured[message] = _Measured()
                measured[message].feed(steps)

    def finish(
        self, seen: Mapping[type[Message], Presence], by_frame: Collection[type[Message]]
    ) -> tuple[Periods, ...]:
        """One per message that has a period and came, in the protocol's order.

        ``seen`` is what came of each message, ``by_frame`` those of several frames a cycle of
        which one frame came each period.
        """
        return tuple(
            self._periods(message, message.PERIOD, seen[message].frames, by_frame)
            for message in self._messages
            if message.PERIOD and message in self._whole
        )

    def _periods(
        self,
        message: type[Message],
        period: float,
        frames: int,
        by_frame: Collection[type[Message]],
    ) -> Periods:
        measured = (self._each if message in by_frame else self._whole)[message]
        spread = measured.spread
        time, low, high = measured.spans.columns()
        return Periods(
            message=message.NAME,
            period=period,
            frames=frames,
            mean=spread.mean,
            deviation=spread.deviation,
            shortest=spread.shortest if spread.count else math.nan,
            longest=spread.longest if spread.count else math.nan,
            time=time,
            low=low,
            high=high,
        )


class _Measured:
    """The steps of one message so far."""

    def __init__(self) -> None:
        self.spread = Spread()
        self.spans = _Spans()

    def feed(self, steps: Steps) -> None:
        """Note steps."""
        self.spread += steps.spread
        if len(steps):
            self.spans.feed(steps)


class _Spans:
    """The shortest and longest step in each of at most twice `COLUMNS` spans.

    When the log outgrows them, each two of them become one of twice the length.
    """

    def __init__(self) -> None:
        self._span = _SHORTEST_SPAN
        self._low: NDArray[np.float64] = np.full(2 * COLUMNS, np.inf)
        self._high: NDArray[np.float64] = np.full(2 * COLUMNS, -np.inf)

    def feed(self, steps: Steps) -> None:
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
