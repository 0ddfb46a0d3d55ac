"""Typed messages of a protocol for which nothing was generated, such as one read from a DBC."""

from __future__ import annotations

import dataclasses
import logging
from enum import IntEnum
from typing import Any

from typedcan.model import protocol as model
from typedcan.model.kinds import Kind, enums, kind_of
from typedcan.model.layout import readable
from typedcan.model.naming import member_names
from typedcan.model.soundness import remark, with_unique_names
from typedcan.wire.binding import fields_of, selected_of
from typedcan.wire.fields import Field
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol, bind

_LOG = logging.getLogger(__name__)


def typed_protocol(protocol: model.Protocol) -> Protocol:
    """The protocol with message classes and enums made of it, as `dbcspec generate` would.

    The names of its fields have to be names that Python can have beside each other. What cannot
    be had as it stands, such as signals outside of their message, is logged as one warning.
    """
    if odd := remark(protocol):
        _LOG.warning(odd)
    protocol = with_unique_names(protocol)
    codes = {table.name: _enum(table) for table in enums(protocol.messages)}
    classes = [_message_class(message, codes) for message in protocol.messages]
    return bind(protocol, classes, {})


def _enum(table: model.ValueTable) -> type[IntEnum]:
    names = member_names([(code.value, code.english) for code in table.codes])
    made: Any = IntEnum(table.name, {name: code for code, name in names.items()})  # type: ignore[misc]
    kind: type[IntEnum] = made
    return kind


def _message_class(message: model.Message, codes: dict[str, type[IntEnum]]) -> type[Message]:
    parts = fields_of(message, codes)
    selected = selected_of(message)
    fields: list[Any] = []
    for signal in readable(message):
        part = parts[signal.python_name]
        if signal.must_be_given and signal.python_name not in selected:
            fields.append((part.name, Any))
        else:
            default = None if signal.python_name in selected else _default(message, signal, part)
            fields.append((part.name, Any, dataclasses.field(default=default)))
    made: Any = dataclasses.make_dataclass(
        message.name,
        fields,
        bases=(Message,),
        namespace={
            "__doc__": message.comment() or message.name,
            "MODEL": message,
            "NAME": message.name,
            "FRAME_ID": message.frame_id,
            "EXTENDED": message.extended,
            "LENGTH": message.length,
            "SENDER": message.sender,
            "RECEIVERS": message.receivers,
            "PERIOD": message.period / 1000 if message.period else None,
            "FIELDS": parts,
            "CHECKSUM": message.checksum,
            "COUNTER": message.counter,
            "SELECTED": selected,
        },
        frozen=True,
        slots=True,
        kw_only=True,
    )
    kind: type[Message] = made
    return kind


def _default(message: model.Message, signal: model.Signal, part: Field) -> object:
    """What a field holds where nothing is given: the start value as its type has it."""
    raw = signal.start_value
    kind = kind_of(message, signal)
    if kind is Kind.FILLED:
        return None
    if kind is Kind.LABELLED:
        return raw
    if kind is not Kind.FLOAT and raw in part.states:
        return part.states[raw]
    return raw * part.factor + part.offset
