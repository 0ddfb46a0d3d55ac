"""Where the parts of a transfer stand in its frames, from what the protocol says of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from typedcan.wire.message import Message, MessageT
from typedcan.wire.protocol import Transfer


@dataclass(frozen=True, slots=True)
class Slot:
    """One frame of a text transfer.

    ``number`` counts the frames from 1; ``used`` and ``unused`` are the fields that hold
    characters of the text, in order, and those that hold none.
    """

    message: type[Message]
    number: int
    used: tuple[str, ...]
    unused: tuple[str, ...] = ()


def text_slots(transfer: Transfer) -> tuple[Slot, ...]:
    """The frames of a text transfer, in order."""
    slots: list[Slot] = []
    left = transfer.count or 0
    while left > 0:
        number = len(slots) + 1
        fields = _fields_of(transfer, number)
        message = transfer.messages[0 if transfer.frame_number else number - 1]
        slots.append(Slot(message, number, fields[:left], fields[left:]))
        left -= len(fields)
    return tuple(slots)


def _fields_of(transfer: Transfer, number: int) -> tuple[str, ...]:
    if transfer.frame_number:
        return tuple(item.field for item in transfer.items)
    message = transfer.messages[number - 1]
    return tuple(item.field for item in transfer.items if item.message is message)


def frame_number(transfer: Transfer, message: Message) -> int:
    """Which frame of the transfer a message is, as far as its own words go."""
    if transfer.frame_number is None:
        return transfer.messages.index(type(message)) + 1
    number: int = getattr(message, transfer.frame_number.field)
    return number


def characters(transfer: Transfer) -> frozenset[str]:
    """The characters that every part of a text transfer can hold."""
    tables = (frozenset(item.message.FIELDS[item.field].labels.values()) for item in transfer.items)
    return frozenset.intersection(*tables)


def create(message: type[MessageT], values: Mapping[str, Any]) -> MessageT:
    """A message from its fields by name."""
    make: Callable[..., MessageT] = message
    return make(**values)


def group_word(transfer: Transfer) -> str:
    """What a group is called, as the title of the field that names it says."""
    if transfer.group is None:
        return "group"
    field = transfer.group.message.FIELDS[transfer.group.field]
    return field.title.removesuffix(" number") or field.name
