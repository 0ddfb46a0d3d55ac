"""What a promise of a protocol is, and what it means to break it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from enum import IntEnum, StrEnum

from dbcspec.compare.pairing import MessagePair, Pairing, SignalPair
from dbcspec.errors import Location


class Class(IntEnum):
    """How grave a change is, gravest last."""

    COSMETIC = 0
    ADDITIVE = 1
    SOURCE = 2
    WIRE = 3

    @property
    def word(self) -> str:
        """The class as people and options write it."""
        return self.name.lower()


class Breaks(StrEnum):
    """Which side a change breaks when the other one has it and this one has not."""

    SENDER = "sender"
    RECEIVER = "receiver"
    BOTH = "both"
    NOBODY = "nobody"


@dataclass(frozen=True, slots=True, kw_only=True)
class Change:
    """One broken promise: what it was, what it is, and where the new text stands."""

    message: str
    subject: str
    old: str
    new: str
    where: Location


Check = Callable[[Pairing], Iterable[Change]]


@dataclass(frozen=True, slots=True)
class Promise:
    """A promise: its stable id, what it is for, how grave breaking it is, whom it breaks."""

    id: str
    purpose: str
    class_: Class
    breaks: Breaks
    check: Check


def in_messages(show: Callable[[MessagePair], tuple[str, str]]) -> Check:
    """A check that compares one text of each message, old and new."""

    def check(pairing: Pairing) -> Iterator[Change]:
        for message in pairing.messages:
            old, new = show(message)
            if old != new:
                yield message_change(message, old, new)

    return check


def in_signals(show: Callable[[SignalPair], tuple[str, str]]) -> Check:
    """A check that compares one text of each signal, old and new."""

    def check(pairing: Pairing) -> Iterator[Change]:
        for signal in pairing.signals():
            old, new = show(signal)
            if old != new:
                yield signal_change(signal, old, new)

    return check


def message_change(message: MessagePair, old: str, new: str) -> Change:
    """A change of a message as a whole."""
    return Change(
        message=message.new.name,
        subject=message.new.name,
        old=old,
        new=new,
        where=message.new.where,
    )


def signal_change(signal: SignalPair, old: str, new: str) -> Change:
    """A change of a signal."""
    return Change(
        message=signal.new_message.name,
        subject=signal.new.name,
        old=old,
        new=new,
        where=signal.new.where,
    )
