"""Values split into the typed messages that carry them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from typedcan.model.errors import TypedcanError
from typedcan.model.transfers import text
from typedcan.model.transfers.kind import Frame, SplitError
from typedcan.model.transfers.registry import KINDS
from typedcan.model.transfers.set_frames import slots_of
from typedcan.wire.errors import EncodeError
from typedcan.wire.message import Message, MessageT
from typedcan.wire.protocol import Transfer


class TransferError(TypedcanError, ValueError):
    """A value cannot be split into frames: ``transfer`` names it, ``problem`` says why."""

    def __init__(self, transfer: str, problem: str) -> None:
        self.transfer = transfer
        self.problem = problem
        super().__init__(f"{transfer}: {problem}")


def split(transfer: Transfer, value: Any) -> tuple[Message, ...]:
    """The messages that carry a value, in order.

    A text for a text, bytes or numbers for numbered blocks, the readings of each group for
    readings by group; or a value as it arrives, with its details. Raises `TransferError` for what
    the messages cannot carry.
    """
    kind = KINDS.get(transfer.parts.transfer.kind)
    if kind is None:
        raise TransferError(transfer.name, f"there is no kind {transfer.parts.transfer.kind!r}")
    try:
        frames = kind.split(transfer.parts, value)
    except SplitError as error:
        raise TransferError(transfer.name, str(error)) from None
    return tuple(_message(transfer, frame) for frame in frames)


def create(message: type[MessageT], values: Mapping[str, Any]) -> MessageT:
    """A message from its fields by name."""
    make: Callable[..., MessageT] = message
    return make(**values)


@dataclass(frozen=True, slots=True)
class Slot:
    """One frame of a text.

    ``number`` is that of the frame; ``used`` and ``unused`` are the fields that hold characters of
    the text, in order, and those that hold none.
    """

    message: type[Message]
    number: int
    used: tuple[str, ...]
    unused: tuple[str, ...] = ()


def text_slots(transfer: Transfer) -> tuple[Slot, ...]:
    """The frames of a text of a fixed number of characters, in order."""
    return tuple(
        Slot(
            transfer.classes[slot.message],
            slot.number,
            tuple(part.signal.python_name for part in slot.used),
            tuple(part.signal.python_name for part in slot.unused),
        )
        for slot in slots_of(transfer.parts, transfer.count or len(transfer.parts.items))
    )


def characters(transfer: Transfer) -> frozenset[str]:
    """The characters that every part of a text can hold, as value tables name them."""
    return text.characters(transfer.parts)


def _message(transfer: Transfer, frame: Frame) -> Message:
    message = transfer.classes[frame.message]
    fields = {field.dbc_name: field for field in message.FIELDS.values()}
    values: dict[str, Any] = {}
    for signal, value in frame.values.items():
        field = fields[signal]
        values[field.name] = value
        try:
            field.to_raw(message.NAME, value)
        except EncodeError as error:
            called = frame.called.get(signal, signal)
            raise TransferError(transfer.name, f"{called}: {error.problem}") from None
    return create(message, values)
