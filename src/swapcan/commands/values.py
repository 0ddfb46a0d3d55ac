"""Messages from what people type: names, and values as text."""

from __future__ import annotations

import difflib
import re
import typing
from collections.abc import Sequence
from enum import IntEnum

from swapcan.console import CommandError
from swapcan.message import (
    CharacterField,
    Field,
    FilledField,
    LabelledField,
    Message,
    PhysicalField,
    SignalState,
    Value,
)
from swapcan.messages import MESSAGES

_STATES = {"invalid": SignalState.INVALID, "abnormal": SignalState.ABNORMAL}


def message_named(name: str) -> type[Message]:
    """The message class of a name in any case; raises `CommandError`."""
    by_name = {kind.NAME.casefold(): kind for kind in MESSAGES}
    if kind := by_name.get(name.casefold()):
        return kind
    raise CommandError(
        _unknown(f"there is no message {name!r}", name, [kind.NAME for kind in MESSAGES])
    )


def message_of(kind: type[Message], assignments: Sequence[str]) -> Message:
    """The message with fields such as ``soc=80`` set.

    Raises `CommandError` for what cannot be read as a value, and `EncodeError` for a code that
    the field has not; other values are checked when the message is encoded.
    """
    values: dict[str, Value] = {}
    for assignment in assignments:
        name, equals, text = assignment.partition("=")
        if not equals:
            raise CommandError(f"expected FIELD=VALUE, not {assignment!r}")
        field = _field_named(kind, name.strip())
        if field.name in values:
            raise CommandError(f"{kind.NAME}.{field.name} is given twice")
        values[field.name] = _value(kind, field, text.strip())
    return kind(**values)


def _field_named(kind: type[Message], name: str) -> Field:
    for field in kind.FIELDS.values():
        if name.casefold() in (field.name.casefold(), field.dbc_name.casefold()):
            if isinstance(field, FilledField):
                raise CommandError(f"{kind.NAME}.{field.name} is filled in when sending")
            return field
    known = [field.name for field in kind.FIELDS.values() if not isinstance(field, FilledField)]
    raise CommandError(_unknown(f"{kind.NAME} has no field {name!r}", name, known))


def _value(kind: type[Message], field: Field, text: str) -> Value:
    if isinstance(field, LabelledField):
        return _code(kind, field, text)
    if isinstance(field, CharacterField) and len(text) == 1:
        return text
    if state := _STATES.get(text.casefold()):
        return state
    try:
        return float(text) if isinstance(field, PhysicalField) else _whole(text)
    except ValueError:
        what = "a number" if isinstance(field, PhysicalField) else "a whole number"
        what = "a character" if isinstance(field, CharacterField) else what
        raise CommandError(f"{kind.NAME}.{field.name}: expected {what}, not {text!r}") from None


def _whole(text: str) -> int:
    """A whole number, with 0x also hexadecimal."""
    return int(text, 16 if text.casefold().startswith("0x") else 10)


def _code(kind: type[Message], field: LabelledField, text: str) -> int:
    """The code of a number, a label, the name of an enum member, or 'invalid'."""
    try:
        return _whole(text)
    except ValueError:
        codes = _codes(kind, field)
    found = codes.get(_key(text), set())
    if len(found) == 1:
        return found.pop()
    if found:
        numbers = ", ".join(map(str, sorted(found)))
        raise CommandError(f"{kind.NAME}.{field.name}: {text!r} is each of the codes {numbers}")
    known = ", ".join(dict.fromkeys(field.labels.values()))
    raise CommandError(f"{kind.NAME}.{field.name}: unknown label {text!r}; known are {known}")


def _codes(kind: type[Message], field: LabelledField) -> dict[str, set[int]]:
    pairs = [(label, code) for code, label in field.labels.items()]
    for part in typing.get_args(typing.get_type_hints(kind)[field.name]):
        if isinstance(part, type) and issubclass(part, IntEnum):
            pairs += [(member.name, member.value) for member in part]
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
