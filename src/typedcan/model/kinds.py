"""What a signal is in generated Python: a measured value, a number, a code, a character."""

from __future__ import annotations

from enum import Enum

from typedcan.model.codes import is_numbering, value_codes
from typedcan.model.protocol import Message, Signal, ValueTable


class Kind(Enum):
    """The kinds of fields, by the runtime class that carries them."""

    PHYSICAL = "PhysicalField"
    FLOAT = "FloatField"
    NUMBER = "NumberField"
    LABELLED = "LabelledField"
    CHARACTER = "CharacterField"
    FILLED = "FilledField"


def kind_of(message: Message, signal: Signal) -> Kind:
    """The kind of a signal's field."""
    filled = (
        message.checksum and message.checksum.signal,
        message.counter and message.counter.signal,
    )
    if signal.name in filled:
        return Kind.FILLED
    if signal.is_float:
        return Kind.FLOAT
    meanings = value_codes(signal)
    scaled = signal.factor != 1 or signal.offset != 0
    if (
        not scaled
        and meanings
        and all([*map(ord, code.english)] == [code.value] for code in meanings)
    ):
        return Kind.CHARACTER
    if scaled or signal.unit:
        return Kind.PHYSICAL
    return Kind.LABELLED if meanings and not is_numbering(meanings) else Kind.NUMBER


def enums(messages: tuple[Message, ...]) -> dict[ValueTable, tuple[Signal, ...]]:
    """The value tables that become enums, with the signals that have them."""
    found: dict[ValueTable, tuple[Signal, ...]] = {}
    for message in messages:
        for signal in message.signals:
            if signal.value_table and kind_of(message, signal) is Kind.LABELLED:
                found[signal.value_table] = (*found.get(signal.value_table, ()), signal)
    return found
