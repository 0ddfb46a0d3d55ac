"""What the model says of a message, as the parts of its class: fields, and what selects them."""

from __future__ import annotations

from collections.abc import Mapping
from enum import IntEnum
from types import MappingProxyType
from typing import Any

from typedcan.model import protocol as model
from typedcan.model.kinds import Kind, kind_of
from typedcan.model.layout import readable
from typedcan.model.limits import sending_limits
from typedcan.model.scaling import is_fine, is_whole, scaling_of
from typedcan.wire.fields import (
    CharacterField,
    ExactField,
    Field,
    FilledField,
    FloatField,
    LabelledField,
    NumberField,
    PhysicalField,
)
from typedcan.wire.message import Selected

_KINDS: Mapping[Kind, type[Field]] = {
    Kind.PHYSICAL: PhysicalField,
    Kind.FLOAT: FloatField,
    Kind.NUMBER: NumberField,
    Kind.CHARACTER: CharacterField,
    Kind.FILLED: FilledField,
}


def fields_of(message: model.Message, enums: Mapping[str, type[IntEnum]]) -> Mapping[str, Field]:
    """The fields of a message by their names, in the order of their bits.

    ``enums`` are those of the value tables, by the names of these.
    """
    fields = (_field(message, signal, enums) for signal in readable(message))
    return MappingProxyType({field.name: field for field in fields})


def selected_of(message: model.Message) -> Selected:
    """The fields of branches: the field of the selector, and the raw values that select them."""
    names = {signal.name: signal.python_name for signal in readable(message)}
    return MappingProxyType(
        {
            names[signal.name]: (names[signal.multiplexer], signal.selectors)
            for signal in message.signals
            if signal.name in names and signal.multiplexer
        }
    )


def _field(
    message: model.Message, signal: model.Signal, enums: Mapping[str, type[IntEnum]]
) -> Field:
    kind = kind_of(message, signal)
    facts = _facts(signal, kind)
    if kind is Kind.LABELLED and signal.value_table:
        return LabelledField(**facts, enum=enums[signal.value_table.name])
    if kind is Kind.PHYSICAL and (is_whole(signal) or is_fine(signal)):
        return ExactField(**facts)
    return _KINDS[kind](**facts)


def _facts(signal: model.Signal, kind: Kind) -> dict[str, Any]:
    facts: dict[str, Any] = {
        "signal": signal,
        "name": signal.python_name,
        "dbc_name": signal.name,
        "title": signal.english,
        "unit": signal.unit,
        "reference": signal.reference,
        "length": signal.length,
        "acting": signal.acting,
    }
    if kind in (Kind.LABELLED, Kind.CHARACTER) and signal.value_table:
        facts["labels"] = MappingProxyType(signal.value_table.labels())
    if kind is not Kind.FLOAT:
        facts["states"] = signal.states
    if kind in (Kind.PHYSICAL, Kind.FLOAT):
        facts["factor"], facts["offset"] = scaling_of(signal)
    minimum, maximum = sending_limits(signal, kind)
    return {**facts, "minimum": minimum, "maximum": maximum}
