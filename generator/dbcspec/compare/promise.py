"""What a promise of a protocol is, and what it means to break it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from enum import IntEnum, StrEnum
from typing import TypeVar

from dbcspec.compare.pairing import MessagePair, Pairing, SignalPair
from typedcan.model.errors import Location
from typedcan.model.protocol import NOWHERE, Aspect, ByteOrder, Message, Signal

T = TypeVar("T")


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
    """Whose old program fails against a new one on the other side.

    ``SENDER``: an old sender is not understood by a new receiver; ``RECEIVER``: an old receiver
    does not understand a new sender. Of a class ``source`` change it says whose code must follow.
    """

    SENDER = "sender"
    RECEIVER = "receiver"
    BOTH = "both"
    NOBODY = "nobody"


@dataclass(frozen=True, slots=True, kw_only=True)
class Change:
    """One broken promise: of what, what it was, what it is, and where the new text stands.

    ``message`` is empty where the protocol as a whole is spoken of.
    """

    message: str
    subject: str
    text: str
    old: str
    new: str
    where: Location


Check = Callable[[Pairing], Iterable[Change]]


@dataclass(frozen=True, slots=True)
class Promise:
    """A promise: its stable id, what it is for, how grave breaking it is, whom it breaks.

    It is kept where either side cannot say what ``needs`` names.
    """

    id: str
    purpose: str
    class_: Class
    breaks: Breaks
    check: Check
    needs: Aspect | None = None

    def changes(self, pairing: Pairing) -> Iterable[Change]:
        """Where two protocols break it."""
        if self.needs and self.needs not in pairing.old.carries & pairing.new.carries:
            return ()
        return self.check(pairing)


def in_messages(word: str, value: Callable[[Message], T], show: Callable[[T], str] = str) -> Check:
    """A check that one value of each message stays; ``word`` is what people call it."""

    def check(pairing: Pairing) -> Iterator[Change]:
        for message in pairing.messages:
            old, new = value(message.old), value(message.new)
            if old != new:
                yield message_change(message, word, show(old), show(new))

    return check


def in_signals(word: str, value: Callable[[Signal], T], show: Callable[[T], str] = str) -> Check:
    """A check that one value of each signal stays; ``word`` is what people call it."""

    def check(pairing: Pairing) -> Iterator[Change]:
        for signal in pairing.signals:
            old, new = value(signal.old), value(signal.new)
            if old != new:
                yield signal_change(signal, word, show(old), show(new))

    return check


def message_change(message: MessagePair, word: str, old: str, new: str) -> Change:
    """A change of a message as a whole."""
    return Change(
        message=message.new.name,
        subject=message.new.name,
        text=from_to(word, old, new),
        old=old,
        new=new,
        where=message.new.where,
    )


def signal_change(signal: SignalPair, word: str, old: str, new: str) -> Change:
    """A change of a signal."""
    return Change(
        message=signal.new_message.name,
        subject=signal.new.name,
        text=from_to(word, old, new),
        old=old,
        new=new,
        where=signal.new.where,
    )


def protocol_change(subject: str, word: str, old: str, new: str) -> Change:
    """A change of what belongs to no message."""
    return Change(
        message="",
        subject=subject,
        text=from_to(word, old, new),
        old=old,
        new=new,
        where=NOWHERE,
    )


def gone(message: str, subject: str, what: str, old: str, where: Location) -> Change:
    """Something that was there and is no more; ``where`` is on the old side."""
    return Change(
        message=message, subject=subject, text=f"{what} removed", old=old, new="", where=where
    )


def fresh(message: str, subject: str, what: str, new: str, where: Location) -> Change:
    """Something that was not there before."""
    return Change(
        message=message, subject=subject, text=f"{what} added", old="", new=new, where=where
    )


def from_to(word: str, old: str, new: str) -> str:
    """``factor 0.1 → 1``; what is empty is called none."""
    return f"{word} {old or 'none'} → {new or 'none'}"


def listed(names: Iterable[str]) -> str:
    """Names in a row."""
    return ", ".join(names)


def hex_id(frame_id: int) -> str:
    """An identifier as people write it."""
    return f"0x{frame_id:X}"


def place(signal: Signal) -> str:
    """Where a signal is, as DBC files write it: ``16|8@1``."""
    order = 1 if signal.byte_order is ByteOrder.INTEL else 0
    return f"{signal.start}|{signal.length}@{order}"
