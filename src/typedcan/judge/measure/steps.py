"""The steps in time between frames that carry the same, measured once for all who ask.

For most messages that is the step from one frame to the next. Cell voltages and probe temperatures
take several frames a cycle: there it is the step to the next frame of the same CSC and number.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.decoded import DecodedChunk
from typedcan.judge.measure.asked import Asked, requests_of
from typedcan.judge.measure.presence import Presences, Silence, Start
from typedcan.judge.measure.spread import Spread, spread_of
from typedcan.judge.series import Series
from typedcan.judge.tolerance import ASKED_ANEW, Limits
from typedcan.model.transfer import Pace
from typedcan.wire.message import Message
from typedcan.wire.protocol import FieldRef, Protocol

_SHORTEST = 1e-6
"""Seconds: steps are not measured any finer."""

_KEY_BITS = 8
"""Bits of a group, and of a frame number, of which `key_of` makes one number."""


def keyed(protocol: Protocol) -> dict[type[Message], tuple[str, str]]:
    """Messages of several frames a cycle: the fields of the group and of the frame number.

    Where one frame comes in a period, whichever it is, each is one cycle.
    """
    return {
        transfer.messages[0]: (transfer.group.field, transfer.frame_number.field)
        for transfer in protocol.transfers
        if transfer.group and transfer.frame_number
        if transfer.parts.transfer.pace is Pace.ALL_IN_PERIOD
        if all(_is_byte(ref) for ref in (transfer.group, transfer.frame_number))
    }


def _is_byte(ref: FieldRef) -> bool:
    return ref.message.FIELDS[ref.field].length <= _KEY_BITS


class Steps:
    """The steps of one message that end in one chunk, in no order; n of them.

    Left out are those that go back in time, lie across a silence of the node, or go from one
    request to the next: across a change of what is asked for, or, where that is not in the log,
    longer than three periods.

    Parameters
    ----------
    message
        Whose.
    time, length
        When each ended, in seconds since the log's begin, and how long it was, in seconds.
    keys
        Of a message of several frames a cycle the `key_of` each; else None.
    before
        Gives the numbers in the log of the frames with which steps begin, by their indices.
    """

    def __init__(
        self,
        message: type[Message],
        time: NDArray[np.float64],
        length: NDArray[np.float64],
        keys: NDArray[np.uint16] | None,
        before: Callable[[NDArray[np.intp]], NDArray[np.int64]],
    ) -> None:
        self.message = message
        self.time = time
        self.length = length
        self.before = before
        self._keys = keys

    def __len__(self) -> int:
        """How many steps."""
        return len(self.length)

    def detail(self, step: int) -> str:
        """Which frame of the cycle a step is about; empty where a cycle has one."""
        return "" if self._keys is None else frame_of_cycle(int(self._keys[step]))

    @cached_property
    def spread(self) -> Spread:
        """Their mean and deviation."""
        return spread_of(self.length)

    def only(self, which: NDArray[np.bool_]) -> Steps:
        """Some of them."""
        if which.all():
            return self
        kept = np.flatnonzero(which)
        keys = None if self._keys is None else self._keys[kept]
        before = self.before
        return Steps(
            self.message,
            self.time[kept],
            self.length[kept],
            keys,
            lambda steps: before(kept[steps]),
        )


def key_of(series: Series, fields: tuple[str, str]) -> NDArray[np.uint16]:
    """The group, and in the lower eight bits the frame number, of the new rows of a series.

    ``fields`` are those of `keyed`.
    """
    group, number = (series.new_raw(field) for field in fields)
    return group.astype(np.uint16) * np.uint16(256) + number.astype(np.uint16)


def frame_of_cycle(key: int) -> str:
    """A `key_of` for people."""
    return f"CSC {key >> 8} frame {key & 0xFF}"


class Stopped(NamedTuple):
    """The last frame of a message, or of one place in its cycle, in seconds and by its number."""

    message: type[Message]
    detail: str
    time: float
    order: int


@dataclass(frozen=True, slots=True)
class Timing:
    """What `StepMeter` found in one chunk.

    Parameters
    ----------
    steps
        Of each message with a period.
    silences
        Silences of nodes that ended in the chunk.
    starts
        Nodes that began to send in it.
    each
        Of each message of several frames a cycle, the steps from one frame to the next.
    """

    steps: Mapping[type[Message], Steps]
    silences: tuple[Silence, ...]
    starts: tuple[Start, ...]
    each: Mapping[type[Message], Steps]

    def of(self, message: type[Message], *, by_frame: bool = False) -> Steps | None:
        """The steps of a message; None where it did not come, or has no period.

        With ``by_frame`` of one of several frames a cycle those from one frame to the next.
        """
        return (self.each if by_frame else self.steps).get(message)


class StepMeter:
    """Measures the steps of one log, chunk after chunk."""

    def __init__(self, protocol: Protocol, limits: Limits) -> None:
        self.presences = Presences(protocol, limits)
        self._asked_anew = limits.limit(ASKED_ANEW)
        self._protocol = protocol
        self._asked = Asked(protocol)
        self._requested = frozenset(requests_of(protocol))
        self._keyed = keyed(protocol)
        self._tables: dict[type[Message], _Table] = {}
        self._spreads = {message: (Spread(), Spread()) for message in self._keyed}

    def feed(self, chunk: DecodedChunk) -> Timing:
        """Measure the next frames."""
        known = [seen.silences[-1] for seen in self.presences.nodes.values() if seen.silences]
        silences, starts = self.presences.feed(chunk)
        steps: dict[type[Message], Steps] = {}
        single: dict[type[Message], Steps] = {}
        for message in self._protocol.messages:
            series = chunk.frames(message)
            if message.PERIOD and series.fresh:
                own = [each for each in (*known, *silences) if each.node == message.SENDER]
                steps[message] = self._judged(self._steps(series, chunk), message.PERIOD, own)
                if message in self._keyed:
                    single[message] = self._judged(_by_frame(series), message.PERIOD, own)
                    whole, each = self._spreads[message]
                    self._spreads[message] = (
                        whole + steps[message].spread,
                        each + single[message].spread,
                    )
            elif message in self._requested and message.PERIOD:
                self._asked.changes(chunk, message)
        return Timing(steps, tuple(silences), tuple(starts), single)

    def by_frame(self) -> frozenset[type[Message]]:
        """The messages of several frames a cycle of which one frame came each period.

        Whether a printed period is that of a frame or of the whole cycle shows in what is nearer.
        """
        return frozenset(
            message
            for message, (whole, each) in self._spreads.items()
            if each.count
            and _off(each, message) < (_off(whole, message) if whole.count else np.inf)
        )

    def stopped(self) -> Iterator[Stopped]:
        """What came last of each message, and of each place in the cycle of those of several."""
        for message, seen in self.presences.messages.items():
            if message in self._keyed:
                yield from self._tables[message].stopped()
            else:
                yield Stopped(message, "", seen.last, seen.last_order)

    def _steps(self, series: Series, chunk: DecodedChunk) -> Steps:
        message = series.message
        if message in self._keyed:
            if message not in self._tables:
                self._tables[message] = _Table(message, self._keyed[message])
            return self._tables[message].feed(series)
        order = series.order
        steps = _by_frame(series)
        if message in self._requested:
            changes = self._asked.changes(chunk, message)
            steps = steps.only(np.diff(np.searchsorted(changes, order)) == 0)
        return steps

    def _judged(self, steps: Steps, period: float, silences: list[Silence]) -> Steps:
        """Those that say something about the period."""
        if len(steps) and steps.length.min() < 0:
            steps = steps.only(steps.length >= 0)
        if steps.message in self._protocol.conditional:
            steps = steps.only(steps.length <= self._asked_anew * period)
        if silences:
            # The last silence that ended by then: a step that is not across it is across none.
            ends = np.array([silence.end for silence in silences])
            middles = np.array([-np.inf, *(silence.middle for silence in silences)])
            last = np.searchsorted(ends, steps.time, "right")
            steps = steps.only(steps.time - steps.length >= middles[last])
        return steps


def _by_frame(series: Series) -> Steps:
    order = series.order
    return Steps(series.message, series.time[1:], np.diff(series.time), None, lambda at: order[at])


def _off(spread: Spread, message: type[Message]) -> float:
    """How far a mean step is from the period, whether it is longer or shorter."""
    return abs(math.log(max(spread.mean, _SHORTEST) / (message.PERIOD or 1.0)))


class _Table:
    """When and where each frame of a cycle came last."""

    def __init__(self, message: type[Message], fields: tuple[str, str]) -> None:
        self.message = message
        self._fields = fields
        self._time = np.full(1 << 16, np.nan)
        self._order = np.full(1 << 16, -1, np.int64)

    def feed(self, series: Series) -> Steps:
        """The steps of the new rows."""
        keys = key_of(series, self._fields)
        by = np.argsort(keys, kind="stable")
        keys, time = keys[by], series.time[series.first :][by]
        order = series.order[series.first :]
        heads = np.flatnonzero(np.concatenate([[True], keys[1:] != keys[:-1]]))
        tails = np.concatenate([heads[1:], [len(keys)]]) - 1
        length = np.empty(len(time))
        np.subtract(time[1:], time[:-1], out=length[1:])
        length[heads] = time[heads] - self._time[keys[heads]]
        came = self._order[keys[heads]]

        def before(steps: NDArray[np.intp]) -> NDArray[np.int64]:
            head = np.searchsorted(heads, steps, "right") - 1
            return np.where(heads[head] == steps, came[head], order[by[steps - 1]])

        self._time[keys[tails]] = time[tails]
        self._order[keys[tails]] = order[by[tails]]
        found = Steps(self.message, time, length, keys, before)
        return found.only(~np.isnan(length)) if np.isnan(length[heads]).any() else found

    def stopped(self) -> Iterator[Stopped]:
        """The last frame of each place in the cycle."""
        for key in np.flatnonzero(self._order >= 0).tolist():
            yield Stopped(
                self.message, frame_of_cycle(key), float(self._time[key]), int(self._order[key])
            )
