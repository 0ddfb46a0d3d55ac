"""Alive counters: filled in on sending, checked on receipt."""

from __future__ import annotations

from typing import Literal, NamedTuple

from typedcan.wire.message import Message

CounterFault = Literal["repeated", "skipped", "invalid"]
"""What an alive counter did: stay as it was, leave values out, or hold none."""


class SendCounters:
    """The alive counters of one sender, one per message."""

    def __init__(self) -> None:
        self._next: dict[type[Message], int] = {}

    def peek(self, message: type[Message]) -> int | None:
        """The value for the next transmission, None where the message has no counter."""
        counter = message.COUNTER
        return None if counter is None else self._next.get(message, counter.first)

    def advance(self, message: type[Message]) -> None:
        """Go on to the next value: the one that `peek` gave is on the bus."""
        counter = message.COUNTER
        if counter is not None:
            self._next[message] = counter.after(self._next.get(message, counter.first))


class CounterProblem(NamedTuple):
    """What is wrong with a counter: which kind of fault, and in words."""

    kind: CounterFault
    text: str


class ReceiveCounters:
    """What the alive counters of the other nodes were last, and what they should be next."""

    def __init__(self) -> None:
        self._next: dict[tuple[type[Message], int], int] = {}

    def problem(self, kind: type[Message], value: int, frame_id: int = 0) -> CounterProblem | None:
        """What is wrong with the counter of a message just received, or None.

        Each identifier with which it comes counts for itself: several nodes may send one PGN. The
        first message of a kind sets the counter; so does one with a wrong counter, so that a single
        lost frame is reported once.
        """
        counter = kind.COUNTER
        if counter is None:
            return None
        key = kind, frame_id
        expected = self._next.get(key)
        if value != expected and not counter.holds(value):
            self._next.pop(key, None)
            said = kind.field_of(counter.signal).states.get(value, value)
            return CounterProblem("invalid", f"counter is {said}, it runs {counter}")
        self._next[key] = counter.after(value)
        if expected is None or value == expected:
            return None
        last = counter.before(expected)
        if value == last:
            return CounterProblem("repeated", f"counter stays at {value}")
        text = f"counter goes from {last} to {value}, expected {expected}"
        return CounterProblem("skipped", text)
