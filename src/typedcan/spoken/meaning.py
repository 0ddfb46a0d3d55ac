"""What a value of one field is in another that means the same: codes by label, states by state."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from typedcan.model.signal_state import SignalState
from typedcan.wire.errors import EncodeError
from typedcan.wire.fields import Field, LabelledField, NumberField, PhysicalField

Convert = Callable[[Any], Any]

_UNKNOWN = object()
"""Stands for a meaning that the other side has no code for."""


def to_edition(
    field: Field, other: Field, message: str, name: str, *, strict: bool = True
) -> Convert:
    """What turns a value of an own field into one of the field that the edition has for it.

    It raises `EncodeError` for what the edition, called ``name``, cannot say; where it is not
    ``strict`` that is invalid if there is a code for it.
    """
    codes = _codes(field, other)
    instead = _UNKNOWN if strict else _state(other, SignalState.INVALID)

    def say(value: Any) -> Any:
        if isinstance(field, LabelledField):
            code = field.to_raw(message, value)
            said = codes.get(code, _UNKNOWN if code in other.labels else code)
        elif isinstance(value, SignalState):
            said = _state(other, value)
        else:
            said = _number(other, value)
        said = instead if said is _UNKNOWN else said
        if said is _UNKNOWN:
            problem = f"{name} has no code for {field.text(value)}"
            raise EncodeError(message, field.name, value, problem)
        return said

    return say


def to_own(other: Field, field: Field) -> Convert:
    """What turns a value of a field of the edition into one of the own field."""
    codes = _codes(other, field)

    def hear(value: Any) -> Any:
        if not isinstance(field, LabelledField):
            if not isinstance(other, LabelledField):
                return _number(field, value)
            # The number that it is, of whatever it is called there.
            return SignalState.INVALID if value == other.signal.invalid_code else int(value)
        if isinstance(value, SignalState):
            known = _state(field, value)
        else:
            known = codes.get(value, _UNKNOWN if value in field.labels else value)
        if known is _UNKNOWN:
            invalid = field.signal.invalid_code
            known = invalid if invalid is not None else ~value if isinstance(value, int) else -1
        return member(field, int(known))

    return hear


def member(field: LabelledField, code: int) -> Any:
    """A code as a labelled field holds it."""
    return field.enum(code) if code in field.labels else code


def _state(field: Field, state: SignalState) -> Any:
    """What a field has for a state: the state, a code, or `_UNKNOWN`."""
    if not isinstance(field, LabelledField):
        return state if state in field.states.values() else _UNKNOWN
    code = _code_of(field, str(state))
    if code is None and state is SignalState.INVALID:
        code = field.signal.invalid_code
    return _UNKNOWN if code is None else code


def _codes(field: Field, other: Field) -> Mapping[int, Any]:
    """By the codes of a field, those of the other with the same meaning, or `_UNKNOWN`."""
    if not isinstance(field, LabelledField):
        return {}
    codes: dict[int, Any] = {}
    for code, label in field.labels.items():
        same = _meaning(other.labels.get(code, "")) == _meaning(label)
        found = code if same else _code_of(other, label)
        codes[code] = _UNKNOWN if found is None else found
    invalid = field.signal.invalid_code
    if invalid is not None and codes.get(invalid, _UNKNOWN) is _UNKNOWN:
        codes[invalid] = _state(other, SignalState.INVALID)
    return codes


def _code_of(field: Field, label: str) -> int | None:
    """The first code with a label; None where there is none."""
    wanted = _meaning(label)
    return next((code for code, text in field.labels.items() if _meaning(text) == wanted), None)


def _meaning(label: str) -> str:
    return " ".join(label.casefold().split())


def _number(field: Field, value: Any) -> Any:
    """A value as the kind of a field has it."""
    if isinstance(value, float) and type(field) is NumberField and value.is_integer():
        return int(value)
    if isinstance(value, int) and type(field) is PhysicalField:
        return float(value)
    return value
