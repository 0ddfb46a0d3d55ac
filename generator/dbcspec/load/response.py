"""Worst-case response times of frames on one bus, by the revised analysis.

R. I. Davis, A. Burns, R. J. Bril, J. J. Lukkien: Controller Area Network (CAN) schedulability
analysis: refuted, revisited and revised. Real-Time Systems 35 (2007). A frame cannot be
interrupted, so that a later instance of a message within one busy period may wait longer than the
first: all of them are looked at. A message of several frames a cycle has them queued together;
its response time is that of the last one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

Time = Fraction
"""Seconds, exact: a bound must not depend on how a float rounds."""

_ZERO = Time(0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Stream:
    """A message as the bus sees it; the lower the identifier, the sooner it wins arbitration.

    Parameters
    ----------
    priority
        Sorts as the bus arbitrates: the lowest first.
    time
        Longest transmission time of one frame, in s.
    period
        Shortest time from one cycle to the next, in s.
    frames
        How many frames a cycle has.
    jitter
        Longest delay from the cycle's beginning until its frames are queued, in s.
    deadline
        In s; the period where it is None.
    """

    name: str
    priority: int
    time: Time
    period: Time
    frames: int = 1
    jitter: Time = _ZERO
    deadline: Time | None = None

    @property
    def limit(self) -> Time:
        """The time within which the last frame of a cycle is to be sent."""
        return self.period if self.deadline is None else self.deadline

    @property
    def utilisation(self) -> Fraction:
        """The part of the bus that it takes."""
        return self.time * self.frames / self.period


@dataclass(frozen=True, slots=True)
class Response:
    """A worst-case response time; None where there is no bound, since the bus is overloaded."""

    stream: Stream
    worst: Time | None

    @property
    def in_time(self) -> bool:
        """Whether the message is always sent within its deadline."""
        return self.worst is not None and self.worst <= self.stream.limit


def worst_case_responses(streams: Sequence[Stream], bit_time: Time) -> list[Response]:
    """The worst-case response time of each stream on one bus; ``bit_time`` is in s."""
    ordered = sorted(streams, key=lambda stream: stream.priority)
    return [
        Response(stream, _worst(stream, ordered[:index], ordered[index + 1 :], bit_time))
        for index, stream in enumerate(ordered)
    ]


def _worst(
    stream: Stream, higher: Sequence[Stream], lower: Sequence[Stream], bit_time: Time
) -> Time | None:
    if sum(each.utilisation for each in (*higher, stream)) >= 1:
        return None
    blocking = max((each.time for each in lower), default=_ZERO)
    busy = _busy_period((*higher, stream), blocking)
    instances = -((busy + stream.jitter) // -stream.period)
    worst, queued = _ZERO, blocking
    for instance in range(instances):
        before = blocking + ((instance + 1) * stream.frames - 1) * stream.time
        queued = _queueing(max(queued, before), before, higher, bit_time)
        worst = max(worst, stream.jitter + queued - instance * stream.period + stream.time)
    return worst


def _busy_period(streams: Sequence[Stream], blocking: Time) -> Time:
    """The longest time in which frames of these streams, one after the other, hold the bus."""
    length = blocking + sum((each.time * each.frames for each in streams), _ZERO)
    while (longer := blocking + _demand(streams, length, _ZERO)) > length:
        length = longer
    return length


def _queueing(start: Time, own: Time, higher: Sequence[Stream], bit_time: Time) -> Time:
    """How long a frame waits until it is sent: ``own`` is what goes before it in any case."""
    queued = start
    while (longer := own + _demand(higher, queued, bit_time)) > queued:
        queued = longer
    return queued


def _demand(streams: Sequence[Stream], span: Time, bit_time: Time) -> Time:
    """The transmission time that these streams can ask for in a span."""
    return sum(
        (
            -((span + each.jitter + bit_time) // -each.period) * each.frames * each.time
            for each in streams
        ),
        _ZERO,
    )
