"""Typed messages: the base class, and how each kind of field turns values into raw bits."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum, IntEnum
from types import MappingProxyType
from typing import Any, ClassVar, TypeVar

from swapcan.errors import EncodeError


class SignalState(Enum):
    """What a signal says instead of a value."""

    INVALID = "Signal Invalid"
    ABNORMAL = "Abnormal"

    def __str__(self) -> str:
        return self.value


@dataclass(frozen=True, slots=True, kw_only=True)
class ActingCodes:
    """Codes of a signal at which its receiver acts, and the code that ends that.

    Parameters
    ----------
    codes, safe
        Raw values: those at which the receiver closes a contactor, charges, heats, cools or
        pumps, and the one at which it does not.
    reports
        The codes command nothing, but say that something is on.
    """

    codes: frozenset[int]
    safe: int
    reports: bool = False


Value = float | int | str | SignalState | None
"""What a field of a message can hold."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Field:
    """A signal as a field of a message.

    Parameters
    ----------
    name, dbc_name
        The name here and in the DBC file and the standard.
    title, unit, reference
        Short English title, unit, and where in the standard the signal stands.
    length
        Bits of the raw value.
    factor, offset
        Physical value = raw value x factor + offset.
    minimum, maximum
        The physical range that the standard gives.
    states
        Raw values that are no value, and what they mean.
    labels
        Raw values with a meaning and their labels as in the DBC file.
    acting
        Which raw values act, where some do.
    """

    name: str
    dbc_name: str
    title: str
    unit: str = ""
    reference: str = ""
    length: int
    factor: float = 1
    offset: float = 0
    minimum: float
    maximum: float
    states: Mapping[int, SignalState] = field(default_factory=dict[int, SignalState])
    labels: Mapping[int, str] = field(default_factory=dict[int, str])
    acting: ActingCodes | None = None

    def to_raw(self, message: str, value: Any) -> int:
        """The raw value to send; raises `EncodeError`."""
        raise NotImplementedError

    def text(self, value: Value) -> str:
        """The value for people, with label or unit."""
        return str(value)

    def _limits(self) -> str:
        unit = f" {self.unit}" if self.unit else ""
        return f"{self.minimum:.10g} to {self.maximum:.10g}{unit}"

    def _refuse(self, message: str, value: object, problem: str) -> EncodeError:
        return EncodeError(message, self.name, value, problem)

    def _state(self, message: str, value: SignalState) -> int:
        for raw, state in self.states.items():
            if state is value:
                return raw
        raise self._refuse(message, value, f"has no code for {value}")


class PhysicalField(Field):
    """A measured value; it is rounded to the nearest step that the bits can hold."""

    __slots__ = ()

    def to_raw(self, message: str, value: Any) -> int:
        """The raw value to send; raises `EncodeError`."""
        if isinstance(value, SignalState):
            return self._state(message, value)
        try:
            inside = self.minimum <= value <= self.maximum
        except TypeError:
            raise self._refuse(message, value, f"expected a number, not {value!r}") from None
        if not inside:
            raise self._refuse(message, value, self._outside(value))
        raw: int = round((value - self.offset) / self.factor)
        if raw in self.states:
            problem = f"{value:g} would be sent as raw {raw}, which means {self.states[raw]}"
            raise self._refuse(message, value, problem)
        return raw

    def _outside(self, value: float) -> str:
        unit = f" {self.unit}" if self.unit else ""
        if not math.isfinite(value):
            return f"{value} is not a finite number; allowed are {self._limits()}"
        return f"{value:.10g}{unit} is out of range; allowed are {self._limits()}"

    def text(self, value: Value) -> str:
        """The value with its unit."""
        if isinstance(value, SignalState):
            return str(value)
        return f"{value:.10g} {self.unit}".rstrip()


class NumberField(Field):
    """A whole number: a count, an index, a code of the manufacturer's."""

    __slots__ = ()

    def to_raw(self, message: str, value: Any) -> int:
        """The raw value to send; raises `EncodeError`."""
        if isinstance(value, SignalState):
            return self._state(message, value)
        if not isinstance(value, int):
            raise self._refuse(message, value, f"expected a whole number, not {value!r}")
        if not self.minimum <= value <= self.maximum:
            problem = f"{value} is out of range; allowed are {self._limits()}"
            raise self._refuse(message, value, problem)
        if value in self.states:
            raise self._refuse(message, value, f"{value} means {self.states[value]}")
        return value


class LabelledField(Field):
    """One of a few codes; a code without a label is a plain int."""

    __slots__ = ()

    def to_raw(self, message: str, value: Any) -> int:
        """The raw value to send; raises `EncodeError`."""
        if isinstance(value, int) and self.minimum <= value <= self.maximum:
            return value
        if isinstance(value, str):
            known = ", ".join(map(repr, self.labels.values()))
            problem = f"unknown label {value!r}; known: {known}"
        elif isinstance(value, int):
            problem = f"code {int(value)} is out of range; allowed are {self._limits()}"
        else:
            problem = f"expected a code, not {value!r}"
        raise self._refuse(message, value, problem)

    def text(self, value: Value) -> str:
        """The label of the code, or the code where it has none."""
        return self.labels.get(int(value), str(value)) if isinstance(value, int) else str(value)


class CharacterField(Field):
    """One ASCII character; a code that the standard gives no character is a plain int."""

    __slots__ = ()

    def to_raw(self, message: str, value: Any) -> int:
        """The raw value to send; raises `EncodeError`."""
        if isinstance(value, SignalState):
            return self._state(message, value)
        if isinstance(value, str) and len(value) == 1 and self.labels.get(ord(value)) == value:
            return ord(value)
        if isinstance(value, int) and 0 <= value < 1 << self.length:
            return int(value)
        known = "".join(self.labels.values())
        raise self._refuse(message, value, f"{value!r} is none of the characters {known}")

    def text(self, value: Value) -> str:
        """The character, or the code where it is none."""
        return f"0x{value:02X}" if isinstance(value, int) else str(value)


class FilledField(NumberField):
    """A checksum or counter: None until it is sent, then filled in."""

    __slots__ = ()

    def to_raw(self, message: str, value: Any) -> int:
        """The raw value to send, 0 where it is to be filled in; raises `EncodeError`."""
        return 0 if value is None else NumberField.to_raw(self, message, value)


@dataclass(frozen=True, slots=True, kw_only=True)
class Checksum:
    """Where the checksum of a message stands and which bytes, first to last, it covers."""

    field: str
    byte: int
    algorithm: str
    first_byte: int
    last_byte: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Counter:
    """The alive counter of a message: its signal runs 0 to modulus - 1."""

    field: str
    dbc_name: str
    modulus: int


class Message:
    """Base of all typed messages; each is a frozen dataclass with one field per signal.

    Class attributes: ``NAME`` and ``FRAME_ID`` of the standard, ``LENGTH`` in bytes, ``SENDER``
    and ``RECEIVERS``, ``PERIOD`` in seconds or None where it is sent on events only, ``FIELDS``
    by name in the order of their bits, ``CHECKSUM`` and ``COUNTER`` where there is one.
    """

    __slots__ = ()

    NAME: ClassVar[str]
    FRAME_ID: ClassVar[int]
    LENGTH: ClassVar[int]
    SENDER: ClassVar[str]
    RECEIVERS: ClassVar[tuple[str, ...]]
    PERIOD: ClassVar[float | None]
    FIELDS: ClassVar[Mapping[str, Field]]
    CHECKSUM: ClassVar[Checksum | None] = None
    COUNTER: ClassVar[Counter | None] = None

    def to_raw(self) -> dict[str, int]:
        """DBC signal names and raw values; raises `EncodeError` at the first that cannot be."""
        name = self.NAME
        return {
            part.dbc_name: part.to_raw(name, getattr(self, part.name))
            for part in self.FIELDS.values()
        }


MessageT = TypeVar("MessageT", bound=Message)


def fields_by_name(*fields: Field) -> Mapping[str, Field]:
    """The read-only ``FIELDS`` of a message class."""
    return MappingProxyType({part.name: part for part in fields})


def draft_of(message: type[Message]) -> type[Any]:
    """A class with the same slots that can be filled in field by field.

    Setting the fields of a draft and then its ``__class__`` costs a fraction of what creating a
    frozen dataclass does, and ends in the same object.
    """
    return type(f"{message.__name__}Draft", (Message,), {"__slots__": message.__slots__})


def code_table(labels: type[IntEnum] | Mapping[int, str], bits: int) -> tuple[Any, ...]:
    """What each raw value of so many bits decodes to; a code without a label to itself."""
    known = labels if isinstance(labels, Mapping) else {member.value: member for member in labels}
    return tuple(known.get(raw, raw) for raw in range(1 << bits))
