"""When each node sends, and when it is silent."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.decoded import DecodedChunk
from typedcan.judge.tolerance import SILENCE, Limits
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_Key = TypeVar("_Key")


def periods_of(protocol: Protocol) -> dict[type[Message], float]:
    """The periods of the messages that are sent always, in seconds."""
    return {
        message: message.PERIOD
        for message in protocol.messages
        if message.PERIOD and message not in protocol.conditional
    }


def nodes_of(protocol: Protocol) -> tuple[str, ...]:
    """The nodes of a protocol, and what else is named as the sender of a message, maybe empty."""
    return tuple(dict.fromkeys((*protocol.nodes, *(each.SENDER for each in protocol.messages))))


def sent_by(protocol: Protocol, sender: str) -> tuple[type[Message], ...]:
    """The messages with that sender."""
    return tuple(message for message in protocol.messages if sender == message.SENDER)


class Silence(NamedTuple):
    """Nothing of a node from one frame to the next, or to the log's end.

    Parameters
    ----------
    node
        Whose.
    start, order
        Time of the last frame before, in seconds since the log's begin, and its number in the log.
    end, next_order
        The same of the first frame after; the log's end and -1 where none comes.
    """

    node: str
    start: float
    order: int
    end: float
    next_order: int

    @property
    def middle(self) -> float:
        """A time at which the node was silent for sure."""
        return (self.start + self.end) / 2


class Start(NamedTuple):
    """A node begins to send, in the log or after a silence: when, and with which frame."""

    node: str
    time: float
    order: int
    after: Silence | None


@dataclass(slots=True)
class Presence:
    """What came of a node or of a message up to now: the first and the last frame.

    Times are seconds since the log's begin, orders numbers of the frame in the log.
    """

    first: float
    first_order: int
    last: float
    last_order: int
    frames: int = 0

    silences: list[Silence] = field(default_factory=list[Silence])
    """These silences, in their order."""

    @property
    def seconds(self) -> float:
        """How long it sends, without the silences."""
        return self.last - self.first - sum(each.end - each.start for each in self.silences)


class Presences:
    """Follows all nodes and messages through one log."""

    def __init__(self, protocol: Protocol, limits: Limits) -> None:
        self._silent = limits.limit(SILENCE)
        self.nodes: dict[str, Presence] = {}
        self.messages: dict[type[Message], Presence] = {}
        self._protocol = protocol
        self._numbers = {node: number for number, node in enumerate(nodes_of(protocol), 1)}
        self._periods = periods_of(protocol)

    def feed(self, chunk: DecodedChunk) -> tuple[list[Silence], list[Start]]:
        """Go on; what ended and what began in the next frames, in no order."""
        owner = np.zeros(len(chunk.block), np.min_scalar_type(len(self._numbers)))
        for message in self._protocol.messages:
            series = chunk.frames(message)
            if series.fresh:
                order, time = series.order[series.first :], series.time[series.first :]
                owner[order - chunk.first_order] = self._numbers[message.SENDER]
                _go_on(self.messages, message, time, order)
        silences: list[Silence] = []
        starts: list[Start] = []
        for node, number in self._numbers.items():
            rows = np.flatnonzero(owner == number)
            if len(rows):
                time = chunk.block.timestamp[rows] - chunk.begin
                self._follow(node, time, rows + chunk.first_order, silences, starts)
        return silences, starts

    def limit(self, node: str, order: int | None = None) -> float:
        """Seconds after which a node is silent, for what it sent up to a frame of the log."""
        periods = (
            period
            for message, period in self._periods.items()
            if node == message.SENDER
            and message in self.messages
            and (order is None or self.messages[message].first_order <= order)
        )
        return self._silent * min(periods, default=math.inf)

    def silent_at(self, end: float) -> list[Silence]:
        """The nodes that are silent when the log ends."""
        return [
            Silence(node, seen.last, seen.last_order, end, -1)
            for node, seen in self.nodes.items()
            if end - seen.last > self.limit(node)
        ]

    def _follow(
        self,
        node: str,
        time: NDArray[np.float64],
        order: NDArray[np.int64],
        silences: list[Silence],
        starts: list[Start],
    ) -> None:
        if node in self.nodes:
            before = self.nodes[node]
            known_time = np.concatenate([[before.last], time])
            known_order = np.concatenate([[before.last_order], order])
        else:
            starts.append(Start(node, float(time[0]), int(order[0]), None))
            known_time, known_order = time, order
        seen = _go_on(self.nodes, node, time, order)
        gaps = np.diff(known_time)
        for at in np.flatnonzero(gaps > self.limit(node)).tolist():
            start, end = known_time[at : at + 2].tolist()
            last, following = known_order[at : at + 2].tolist()
            silence = Silence(node, start, last, end, following)
            if gaps[at] > self.limit(node, silence.order):
                silences.append(silence)
                starts.append(Start(node, silence.end, silence.next_order, silence))
                seen.silences.append(silence)


def _go_on(
    seen: dict[_Key, Presence], key: _Key, time: NDArray[np.float64], order: NDArray[np.int64]
) -> Presence:
    """Note the frames of a node or a message."""
    if key not in seen:
        seen[key] = Presence(float(time[0]), int(order[0]), 0.0, 0)
    found = seen[key]
    found.last, found.last_order = float(time[-1]), int(order[-1])
    found.frames += len(time)
    return found
