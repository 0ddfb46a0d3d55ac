"""The messages and signals that a transfer names, found in its protocol."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property
from typing import NamedTuple

from typedcan.model.protocol import Message, Protocol, Signal
from typedcan.model.signal_state import SignalState
from typedcan.model.transfer import Counted, Numbering, Pace, Transfer

EVENT_TIMEOUT = 1.0
"""Seconds in which a value that is sent once has to be complete."""


class Part(NamedTuple):
    """A signal in its message."""

    message: Message
    signal: Signal

    @property
    def highest(self) -> int:
        """The highest value that is none of the codes for having none."""
        signal = self.signal
        highest = min(signal.raw_range[1], signal.raw_limits[1])
        while highest in signal.states:
            highest -= 1
        return highest

    @property
    def highest_labelled(self) -> int:
        """The highest value that has a label, or of all where none has."""
        codes = self.signal.value_table.codes if self.signal.value_table else ()
        values = [code.value for code in codes if code.value not in self.signal.states]
        return max(values, default=self.highest)

    def value_of(self, raw: int) -> float | SignalState:
        """What the signal holds where its bits are ``raw``."""
        signal = self.signal
        if raw in signal.states:
            return signal.states[raw]
        if self.is_whole_number:
            return raw
        return float(raw * signal.factor + signal.offset)

    @property
    def is_whole_number(self) -> bool:
        """Whether it holds a number from 0 that is as it stands in the frame."""
        signal = self.signal
        return not (signal.signed or signal.is_float or signal.offset) and signal.factor == 1


class Parts:
    """A transfer with what it names.

    Parameters
    ----------
    transfer
        As the spec says it.
    protocol
        Where its messages are. A signal is one of the transfer's own messages where one has that
        name, else of the first message that has it; ``message.signal`` says which.
    """

    def __init__(self, transfer: Transfer, protocol: Protocol) -> None:
        self.transfer = transfer
        self.protocol = protocol
        by_name = {message.name: message for message in reversed(protocol.messages)}
        self.unknown: list[tuple[str, str]] = []
        """The keys that name what there is not, each with the name."""
        own: list[Message] = []
        for name in transfer.messages:
            if name in by_name:
                own.append(by_name[name])
            else:
                self.unknown.append(("messages", name))
        self.messages = tuple(own)
        self._all = (*own, *protocol.messages)
        self.items = self._found("items", transfer.items)
        self.details = self._found("details", transfer.details)
        self.number = self._part("frame_number")
        self.group = self._part("group")
        self.groups = self._part("groups_signal")
        self.count = self._part("count_signal")
        self.length = self._part("length_signal")

    @property
    def is_own(self) -> frozenset[str]:
        """The names of the messages that carry it."""
        return frozenset(message.name for message in self.messages)

    @property
    def totals(self) -> str:
        """The message that tells how much there is, where it is none of its own; else empty."""
        names = [part.message.name for part in (self.count, self.groups) if part]
        return next((name for name in names if name not in self.is_own), "")

    @property
    def period(self) -> float | None:
        """Seconds from one time that all of it is sent to the next; None where it is no cycle."""
        periods = [message.period for message in self.messages]
        period = max(filter(None, periods), default=None)
        if period and self.transfer.pace is Pace.ONE_A_PERIOD:
            period *= self._most_frames
        period = self.transfer.period or period
        return None if period is None else period / 1000

    @property
    def _most_frames(self) -> int:
        """How many frames a set may have at most, as far as the spec tells."""
        if self.numbers is not None:
            return len(self.numbers)
        if self.number is None:
            return max(1, len(self.messages))
        if self.group is None or self.transfer.numbering is Numbering.THROUGH:
            return self.number.highest
        return self.number.highest_labelled * self.group.highest_labelled

    def seconds(self, timeout: float, frames: int = 0) -> float:
        """The time in which all frames must have come; ``timeout`` is what the kind has.

        ``frames`` is how many there are, where that is known.
        """
        period = self.period
        if period is None:
            return EVENT_TIMEOUT
        if frames and self.transfer.pace is Pace.ONE_A_PERIOD and not self.transfer.period:
            period *= frames / self._most_frames
        return float(self.transfer.timeout or timeout) * period

    @property
    def word(self) -> str:
        """What a group is called, as the title of the signal that names it says."""
        if self.group is None:
            return "group"
        return self.group.signal.english.removesuffix(" number") or self.group.signal.name

    @property
    def table(self) -> str:
        """What tables of logs are called."""
        return self.transfer.table or self.transfer.name

    @property
    def column(self) -> str:
        """What columns of readings are called."""
        return self.transfer.column or self.transfer.name

    @property
    def width(self) -> int:
        """How many items a numbered frame has."""
        return len(self.items)

    @property
    def numbers(self) -> range | None:
        """The numbers of the frames of a set, where the spec fixes how many there are."""
        count = self.transfer.count
        if not (self.number and count and self.items) or self.group:
            return None
        if self.transfer.counted is Counted.ITEMS:
            count = -(count // -self.width)
        return range(self.transfer.first_number, self.transfer.first_number + count)

    @cached_property
    def capacity(self) -> int:
        """How many items its frames have room for, as far as they can be numbered."""
        if self.number is None:
            return len(self.items)
        numbers = self.number.highest - self.transfer.first_number + 1
        if any(part.signal.multiplexer == self.number.signal.name for part in self.items):
            return len(self.items)
        return max(0, numbers) * self.width

    def _part(self, key: str) -> Part | None:
        name: str = getattr(self.transfer, key)
        found = self._found(key, (name,)) if name else ()
        return found[0] if found else None

    def _found(self, key: str, names: Sequence[str]) -> tuple[Part, ...]:
        parts: list[Part] = []
        for name in names:
            part = _find(name, self._all)
            if part is None:
                self.unknown.append((key, name))
            else:
                parts.append(part)
        return tuple(parts)


def field_of(part: Part) -> str:
    """What code calls a signal."""
    return part.signal.python_name or part.signal.name


def _find(name: str, messages: Iterable[Message]) -> Part | None:
    message_name, dot, signal_name = name.rpartition(".")
    for message in messages:
        if not dot or message.name == message_name:
            for signal in message.signals:
                if signal.name == signal_name:
                    return Part(message, signal)
    return None
