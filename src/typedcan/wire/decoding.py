"""Raw values to messages of any class: what stands in where nothing was generated for it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from typedcan.model.frozen import draft_of
from typedcan.wire.fields import (
    CharacterField,
    ExactField,
    Field,
    FloatField,
    LabelledField,
    PhysicalField,
)
from typedcan.wire.message import Message

Decoder = Callable[[Sequence[int]], Message]
"""Raw values, in the order of the class's ``FIELDS``, to a message."""

_Convert = Callable[[Any], Any]


def decoder_of(kind: type[Message]) -> Decoder:
    """What makes messages of a class; fields of branches that are not selected are None."""
    draft = draft_of(kind)
    index = {name: place for place, name in enumerate(kind.FIELDS)}
    parts = [
        (name, place, _converter(field), _conditions(kind, name, index))
        for place, (name, field) in enumerate(kind.FIELDS.items())
    ]

    def decode(raw: Sequence[int]) -> Message:
        message: Any = draft()
        for name, place, convert, conditions in parts:
            there = all(raw[selector] in values for selector, values in conditions)
            setattr(message, name, convert(raw[place]) if there else None)
        message.__class__ = kind
        decoded: Message = message
        return decoded

    return decode


def _conditions(
    kind: type[Message], name: str, index: Mapping[str, int]
) -> tuple[tuple[int, frozenset[int]], ...]:
    """Which raw values the selectors above a field must have."""
    found: list[tuple[int, frozenset[int]]] = []
    while name in kind.SELECTED and len(found) < len(index):
        name, values = kind.SELECTED[name]
        found.append((index[name], frozenset(values)))
    return tuple(found)


def _converter(field: Field) -> _Convert:
    """What turns a raw value into the field's; in the arithmetic of generated decoders."""
    states, labels, factor, offset = field.states, field.labels, field.factor, field.offset
    if isinstance(field, LabelledField):
        members: dict[int, Any] = {member.value: member for member in field.enum}
        return lambda raw: members.get(raw, raw)
    if isinstance(field, FloatField):
        return lambda raw: raw * factor + offset
    if isinstance(field, ExactField):
        return lambda raw: states[raw] if raw in states else raw * factor + offset
    if isinstance(field, PhysicalField):
        return lambda raw: states[raw] if raw in states else float(raw * factor + offset)
    if isinstance(field, CharacterField):
        return lambda raw: states[raw] if raw in states else labels.get(raw, raw)
    return lambda raw: states.get(raw, raw)
