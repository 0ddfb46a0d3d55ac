"""Messages from what people type: names, and values as text."""

from __future__ import annotations

import difflib
import inspect
import re
from collections.abc import Sequence
from decimal import Decimal, InvalidOperation
from typing import Any, cast

from typedcan.model.plain import shown
from typedcan.model.signal_state import SignalState
from typedcan.shell.console import CommandError
from typedcan.wire.fields import (
    CharacterField,
    ExactField,
    Field,
    FilledField,
    LabelledField,
    PhysicalField,
    Value,
)
from typedcan.wire.message import Message

_STATES = {"invalid": SignalState.INVALID, "abnormal": SignalState.ABNORMAL}


def message_named(messages: Sequence[type[Message]], name: str) -> type[Message]:
    """The message class of a name in any case; raises `CommandError`."""
    by_name = {kind.NAME.casefold(): kind for kind in messages}
    if kind := by_name.get(name.casefold()):
        return kind
    raise CommandError(
        _unknown(f"there is no message {shown(name)}", name, [kind.NAME for kind in messages])
    )


def message_of(kind: type[Message], assignments: Sequence[str]) -> Message:
    """The message with fields such as ``soc=80`` set.

    Raises `CommandError` for what cannot be read as a value and for a field that has to be given
    and is not; whether a value can be sent is checked when the message is encoded.
    """
    values: dict[str, Value] = {}
    for assignment in assignments:
        name, equals, text = assignment.partition("=")
        if not equals:
            raise CommandError(f"expected FIELD=VALUE, not {shown(assignment)}")
        field = _field_named(kind, name.strip())
        if field.name in values:
            raise CommandError(f"{kind.NAME}.{field.name} is given twice")
        values[field.name] = value_of(kind, field, text.strip())
    for name, parameter in inspect.signature(kind).parameters.items():
        if parameter.default is parameter.empty and name not in values:
            raise CommandError(_has_to_be_given(kind, kind.FIELDS[name]))
    return kind(**values)


def _has_to_be_given(kind: type[Message], field: Field) -> str:
    """Why a field has no default: what stands for no value, invalid or 0, would act."""
    invalid = (raw for raw, state in field.states.items() if state is SignalState.INVALID)
    label = field.text(next(invalid, 0))
    known = ", ".join(field.labels.values())
    return (
        f"{kind.NAME}.{field.name} has to be given: left out it would be sent as {label};"
        f" it knows {known}"
    )


def find_field(kind: type[Message], name: str) -> Field | None:
    """The field of a name in any case, its own or that of the database; None where none has it."""
    for field in kind.FIELDS.values():
        if name.casefold() in (field.name.casefold(), field.dbc_name.casefold()):
            return field
    return None


def _field_named(kind: type[Message], name: str) -> Field:
    if field := find_field(kind, name):
        if isinstance(field, FilledField):
            raise CommandError(f"{kind.NAME}.{field.name} is filled in when sending")
        return field
    known = [field.name for field in kind.FIELDS.values() if not isinstance(field, FilledField)]
    raise CommandError(_unknown(f"{kind.NAME} has no field {shown(name)}", name, known))


def value_of(kind: type[Message], field: Field, text: str) -> Value:
    """The value of a field that a text stands for; raises `CommandError`."""
    if isinstance(field, LabelledField):
        return _code(kind, field, text)
    if isinstance(field, CharacterField) and len(text) == 1:
        return text
    if state := _STATES.get(text.casefold()):
        return state
    try:
        if isinstance(field, ExactField):
            exact: Any = Decimal(text)  # not all its values are floats
            return cast("Value", exact)
        return float(text) if isinstance(field, PhysicalField) else _whole(text)
    except (ValueError, InvalidOperation):
        what = "a number" if isinstance(field, PhysicalField) else "a whole number"
        what = "a character" if isinstance(field, CharacterField) else what
        problem = f"expected {what}, not {shown(text)}"
        raise CommandError(f"{kind.NAME}.{field.name}: {problem}") from None


def _whole(text: str) -> int:
    """A whole number, with 0x also hexadecimal."""
    return int(text, 16 if text.casefold().startswith("0x") else 10)


def _code(kind: type[Message], field: LabelledField, text: str) -> int:
    """The code of a number, a label, the name of an enum member, or 'invalid'."""
    try:
        return _whole(text)
    except ValueError:
        codes = _codes(field)
    found = codes.get(_key(text), set())
    if len(found) == 1:
        return found.pop()
    if found:
        numbers = ", ".join(map(str, sorted(found)))
        problem = f"{shown(text)} is each of the codes {numbers}"
    else:
        known = ", ".join(dict.fromkeys(field.labels.values()))
        problem = f"unknown label {shown(text)}; known are {known}"
    raise CommandError(f"{kind.NAME}.{field.name}: {problem}")


def _codes(field: LabelledField) -> dict[str, set[int]]:
    pairs = [(label, code) for code, label in field.labels.items()]
    pairs += [(member.name, member.value) for member in field.enum]
    for text, state in _STATES.items():
        pairs += [(text, code) for code, meaning in field.states.items() if meaning is state]
    codes: dict[str, set[int]] = {}
    for text, code in pairs:
        codes.setdefault(_key(text), set()).add(code)
    return codes


def _key(text: str) -> str:
    return re.sub(r"[\W_]+", " ", text).strip().casefold()


def _unknown(problem: str, name: str, names: Sequence[str]) -> str:
    spelt = {each.casefold(): each for each in names}
    close = difflib.get_close_matches(name.casefold(), spelt, n=3)
    if close:
        return f"{problem}; did you mean {' or '.join(spelt[each] for each in close)}?"
    return f"{problem}; known are {', '.join(names)}"
