"""Messages that make something move: which they are, and their safe codes."""

from __future__ import annotations

from collections.abc import Mapping

from typedcan.wire.fields import Field
from typedcan.wire.message import Message

_KNOWN: dict[type[Message], tuple[Field, ...]] = {}  # looked up for every frame that is sent


def acting_fields(kind: type[Message]) -> tuple[Field, ...]:
    """The fields of a message with codes at which its receiver acts.

    Fields that only report that something is on are not among them.
    """
    if kind not in _KNOWN:
        fields = kind.FIELDS.values()
        _KNOWN[kind] = tuple(each for each in fields if each.acting and not each.acting.reports)
    return _KNOWN[kind]


def safe_codes(kind: type[Message]) -> Mapping[str, int]:
    """The safe raw value of each signal of a message that can act, by its DBC name."""
    return {field.dbc_name: field.acting.safe for field in acting_fields(kind) if field.acting}


def what_acts(message: Message) -> tuple[str, ...]:
    """The fields of a message that act with their labels, such as "hv_on_off = HV On"; often none.

    Raises `EncodeError` where such a field has a value that cannot be sent.
    """
    return tuple(
        f"{field.name} = {field.text(getattr(message, field.name))}"
        for field in acting_fields(type(message))
        if _acts(field, message)
    )


def acts(message: Message) -> bool:
    """Whether a message has a code at which its receiver acts; raises as `what_acts`."""
    return any(_acts(field, message) for field in acting_fields(type(message)))


def _acts(field: Field, message: Message) -> bool:
    value = getattr(message, field.name)
    if value is None or field.acting is None:  # of a branch that is not there
        return False
    return field.to_raw(message.NAME, value) in field.acting.codes
