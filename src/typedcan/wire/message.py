"""Typed messages: the base class, and what makes them quickly."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from enum import IntEnum
from functools import partial
from types import MappingProxyType
from typing import Any, ClassVar, NamedTuple, TypeVar

from typedcan.model import protocol as model
from typedcan.model.plain import shown
from typedcan.model.protection import Checksum, Counter
from typedcan.wire.errors import EncodeError
from typedcan.wire.fields import (
    Field,
    FilledField,
)

Selected = Mapping[str, tuple[str, tuple[int, ...]]]
"""Fields of branches: the field that selects each, and the raw values with which it does."""


class Message:
    """Base of all typed messages; each is a frozen dataclass with one field per signal.

    Class attributes: ``MODEL``, all that the model knows of it, ``NAME`` and ``FRAME_ID`` of the
    standard, whether the identifier is ``EXTENDED``, ``LENGTH`` in bytes, ``SENDER`` and
    ``RECEIVERS``, ``PERIOD`` in seconds or None where it is sent on events only, ``FIELDS`` by name
    in the order of their bits, ``CHECKSUM`` and ``COUNTER`` where there is one, ``SELECTED`` for
    the fields of branches.

    A message is what it was made with; `to_raw` and sending refuse values that its fields cannot
    carry. A field with codes takes its own enum or a plain code; an int that is known at run time
    only satisfies type checkers as ``HvCommand(number)``.
    """

    __slots__ = ()

    MODEL: ClassVar[model.Message]
    NAME: ClassVar[str]
    FRAME_ID: ClassVar[int]
    EXTENDED: ClassVar[bool]
    LENGTH: ClassVar[int]
    SENDER: ClassVar[str]
    RECEIVERS: ClassVar[tuple[str, ...]]
    PERIOD: ClassVar[float | None]
    FIELDS: ClassVar[Mapping[str, Field]]
    CHECKSUM: ClassVar[Checksum | None] = None
    COUNTER: ClassVar[Counter | None] = None
    SELECTED: ClassVar[Selected] = MappingProxyType({})

    def to_raw(self) -> dict[str, int]:
        """DBC names and raw values of the signals that are there.

        Raises `EncodeError` at the first value that cannot be sent, where a field of a selected
        branch is not given, and where one of another branch is.
        """
        name = self.NAME
        parts: Iterable[Field] = self.FIELDS.values()
        if self.SELECTED:
            parts = [part for part in parts if self._is_there(part)]
        return {part.dbc_name: part.to_raw(name, getattr(self, part.name)) for part in parts}

    @classmethod
    def field_of(cls, signal: str) -> Field:
        """The field of the signal of that name in the DBC file; raises `KeyError`."""
        return cls.FIELDS[cls.MODEL.signal(signal).python_name]

    def _is_there(self, part: Field) -> bool:
        """Whether the selectors select the branch of a field; raises `EncodeError` as `to_raw`."""
        field, value = part.name, getattr(self, part.name)
        if field not in self.SELECTED:
            return True
        selector, values = self.SELECTED[field]
        above = self.FIELDS[selector]
        chosen = getattr(self, selector)
        there = self._is_there(above) and above.to_raw(self.NAME, chosen) in values
        if there and value is None and not isinstance(part, FilledField):
            problem = f"has to be given where {selector} is {shown(chosen)}"
            raise EncodeError(self.NAME, field, value, problem)
        if not there and value is not None:
            problem = f"is of another branch: {selector} is {shown(chosen)}"
            raise EncodeError(self.NAME, field, value, problem)
        return there


MessageT = TypeVar("MessageT", bound=Message)
MessageT_co = TypeVar("MessageT_co", bound=Message, covariant=True)


class StraightLine(NamedTuple):
    """Generated functions of a message: what its payload says, and its payload.

    The second, if one can be written, takes the alive counter too, None for the message's own.
    """

    decode: Callable[[bytes], Message]
    encode: Callable[[Any, int | None], bytes] | None


def raw_of(message: type[Message]) -> tuple[Callable[[object], int], ...]:
    """What turns a value of each field into the raw one, or raises `EncodeError`."""
    return tuple(partial(field.to_raw, message.NAME) for field in message.FIELDS.values())


def code_table(labels: type[IntEnum] | Mapping[int, str], bits: int) -> tuple[Any, ...]:
    """What each raw value of so many bits decodes to; a code without a label to itself."""
    known = labels if isinstance(labels, Mapping) else {member.value: member for member in labels}
    return tuple(known.get(raw, raw) for raw in range(1 << bits))
