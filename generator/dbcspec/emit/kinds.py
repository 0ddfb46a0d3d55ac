"""What a signal is in generated Python: a measured value, a number, a code, a character."""

from __future__ import annotations

from enum import Enum

from dbcspec.model import Code, Message, Signal, ValueTable


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
    if meanings and all([*map(ord, code.english)] == [code.value] for code in meanings):
        return Kind.CHARACTER
    if meanings and not is_numbering(meanings):
        return Kind.LABELLED
    plain = signal.factor == 1 and signal.offset == 0 and not signal.unit
    return Kind.NUMBER if plain else Kind.PHYSICAL


def value_codes(signal: Signal) -> tuple[Code, ...]:
    """The codes that are values, without those for invalid and abnormal."""
    states = (signal.invalid_code, signal.abnormal_code)
    codes = signal.value_table.codes if signal.value_table else ()
    return tuple(code for code in codes if code.value not in states)


def is_numbering(codes: tuple[Code, ...]) -> bool:
    """Whether labels only repeat the code behind one word, as CSC1, CSC2 and so on do."""
    words = {code.english.removesuffix(str(code.value)) for code in codes}
    return len(words) == 1 and all(code.english.endswith(str(code.value)) for code in codes)


def enums(messages: tuple[Message, ...]) -> dict[ValueTable, tuple[Signal, ...]]:
    """The value tables that become enums, with the signals that have them."""
    found: dict[ValueTable, tuple[Signal, ...]] = {}
    for message in messages:
        for signal in message.signals:
            if signal.value_table and kind_of(message, signal) is Kind.LABELLED:
                found[signal.value_table] = (*found.get(signal.value_table, ()), signal)
    return found
