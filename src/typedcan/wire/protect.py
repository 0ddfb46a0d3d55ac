"""Checksums and alive counters: filled in on sending, checked on receipt."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, NamedTuple

from typedcan.model.checksums import ALGORITHMS, Algorithm
from typedcan.wire.message import Message

__all__ = ["Algorithm"]

STANDARD_ALGORITHMS = ALGORITHMS
"""What specs name; others are the user's to add."""

CounterFault = Literal["repeated", "skipped", "invalid"]
"""What an alive counter did: stay as it was, leave values out, or hold none."""


def expected_checksum(
    message: type[Message], data: bytes, algorithms: Mapping[str, Algorithm]
) -> int | None:
    """The checksum that the payload must carry.

    None where the message has no checksum or no algorithm of that name is known.
    """
    checksum = message.CHECKSUM
    if checksum is None or checksum.algorithm not in algorithms:
        return None
    covered = data[checksum.first_byte : checksum.last_byte + 1]
    return algorithms[checksum.algorithm](covered)


def sealed(message: type[Message], data: bytes, algorithms: Mapping[str, Algorithm]) -> bytes:
    """The payload with its checksum filled in, or as it is where there is none to fill in."""
    value = expected_checksum(message, data, algorithms)
    if value is None or message.CHECKSUM is None:
        return data
    byte = message.CHECKSUM.byte
    return data[:byte] + bytes((value,)) + data[byte + 1 :]


class SendCounters:
    """The alive counters of one sender, one per message, each with its own modulus."""

    def __init__(self) -> None:
        self._next: dict[type[Message], int] = {}

    def peek(self, message: type[Message]) -> int | None:
        """The value for the next transmission, None where the message has no counter."""
        return None if message.COUNTER is None else self._next.get(message, 0)

    def advance(self, message: type[Message]) -> None:
        """Go on to the next value: the one that `peek` gave is on the bus."""
        if message.COUNTER is not None:
            self._next[message] = (self._next.get(message, 0) + 1) % message.COUNTER.modulus


class CounterProblem(NamedTuple):
    """What is wrong with a counter: which kind of fault, and in words."""

    kind: CounterFault
    text: str


class ReceiveCounters:
    """What the alive counters of the other nodes were last, and what they should be next."""

    def __init__(self) -> None:
        self._last: dict[type[Message], int] = {}

    def problem(self, kind: type[Message], value: int) -> CounterProblem | None:
        """What is wrong with the counter of a message just received, or None.

        The first message of a kind sets the counter; so does one with a wrong counter, so that a
        single lost frame is reported once.
        """
        if kind.COUNTER is None:
            return None
        modulus = kind.COUNTER.modulus
        if value >= modulus:
            self._last.pop(kind, None)
            said = kind.FIELDS[kind.COUNTER.field].states.get(value, value)
            return CounterProblem("invalid", f"counter is {said}, it runs 0 to {modulus - 1}")
        last = self._last.get(kind)
        self._last[kind] = value
        if last is None or value == (last + 1) % modulus:
            return None
        if value == last:
            return CounterProblem("repeated", f"counter stays at {value}")
        expected = (last + 1) % modulus
        text = f"counter goes from {last} to {value}, expected {expected}"
        return CounterProblem("skipped", text)
