"""What the model says of a message, as the parts of its class: fields, and what selects them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from enum import IntEnum
from types import MappingProxyType
from typing import Any

from typedcan.model import protocol as model
from typedcan.model.kinds import Kind, kind_of
from typedcan.model.layout import readable
from typedcan.model.scaling import is_fine, is_whole, scaling_of
from typedcan.model.signal_state import SignalState
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
        facts["states"] = _states(signal)
    if kind in (Kind.PHYSICAL, Kind.FLOAT):
        facts["factor"], facts["offset"] = scaling_of(signal)
    minimum, maximum = _limits(signal, kind)
    return {**facts, "minimum": minimum, "maximum": maximum}


def _states(signal: model.Signal) -> Mapping[int, SignalState]:
    pairs = (
        (signal.invalid_code, SignalState.INVALID),
        (signal.abnormal_code, SignalState.ABNORMAL),
    )
    return MappingProxyType({code: state for code, state in pairs if code is not None})


def _limits(signal: model.Signal, kind: Kind) -> tuple[float, float]:
    """What can be sent: physical values, of fields with codes raw ones."""
    if kind is Kind.FLOAT:
        return float(signal.minimum), float(signal.maximum)
    low, high = _sendable(signal, kind)
    if kind is Kind.PHYSICAL and is_whole(signal):
        factor, offset = scaling_of(signal)
        least, most = sorted((low * factor + offset, high * factor + offset))
        return least, most
    return _physical_limits(signal, low, high) if kind is Kind.PHYSICAL else (low, high)


def _sendable(signal: model.Signal, kind: Kind) -> tuple[int, int]:
    """The raw values of the range and, where they make the field, of the codes; if they fit."""
    (low, high), (least, most) = signal.sendable, signal.raw_limits
    if kind is Kind.LABELLED and signal.value_table:
        codes = [code.value for code in signal.value_table.codes]
        low, high = max(min(low, *codes), least), min(max(high, *codes), most)
    return low, high


def _physical_limits(signal: model.Signal, low: int, high: int) -> tuple[float, float]:
    """The physical values of the raw ends; those of over 53 bits, rounded towards each other."""
    factor, offset = scaling_of(signal)
    # In the arithmetic of the decoder, so that limits hold to the last bit.
    ends = sorted(raw * factor + offset for raw in (low, high))
    middle = sum(ends) / 2

    def inwards(value: float) -> float:
        while not low <= round((value - offset) / factor) <= high and value != middle:
            value = math.nextafter(value, middle)
        return value

    return inwards(ends[0]), inwards(ends[1])
