"""The fields of messages: what each kind holds, and how it turns that into raw bits.

What is given to a field may be anything: it is sent as what it means, or refused by `EncodeError`.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import IntEnum
from fractions import Fraction
from typing import Any

from typedcan.model.acting import ActingCodes
from typedcan.model.plain import character, exact_number, integer, real_number, shown, whole_number
from typedcan.model.protocol import Signal
from typedcan.model.signal_state import SignalState
from typedcan.wire.errors import EncodeError

Value = float | int | str | SignalState | None
"""What a field of a message can hold."""

_SHORT_FLOATS = {16: "<e", 32: "<f"}
"""Formats of `struct` by their bits; one of native order makes infinity of what is too large."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Field:
    """A signal as a field of a message.

    Parameters
    ----------
    signal
        All that the model knows of it: start, byte order, sign, titles, errata and so on.
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

    signal: Signal = field(repr=False)
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

    def to_raw(self, message: str, value: object) -> int:
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
    """A measured value; it is rounded to the nearest step that the bits can hold.

    It takes real numbers of any class: also Decimal, Fraction, and numpy's scalars.
    """

    __slots__ = ()

    def to_raw(self, message: str, value: object) -> int:
        """The raw value to send; raises `EncodeError`."""
        if type(value) is SignalState:
            return self._state(message, value)
        number = value if type(value) is float else self._number(message, value)
        if not self.minimum <= number <= self.maximum:
            raise self._refuse(message, value, self._outside(number))
        raw: int = round((number - self.offset) / self.factor)
        if raw in self.states:
            problem = f"{number:g} would be sent as raw {raw}, which means {self.states[raw]}"
            raise self._refuse(message, value, problem)
        return raw

    def _number(self, message: str, value: object) -> float:
        number = real_number(value)
        if number is None:
            problem = f"expected a number, {self._limits()}, not {shown(value)}"
            raise self._refuse(message, value, problem)
        return number

    def _outside(self, number: float) -> str:
        unit = f" {self.unit}" if self.unit else ""
        if not math.isfinite(number):
            return f"{number} is not a finite number; allowed are {self._limits()}"
        return f"{number:.10g}{unit} is out of range; allowed are {self._limits()}"

    def text(self, value: Value) -> str:
        """The value with its unit."""
        if isinstance(value, SignalState):
            return str(value)
        return f"{value:.10g} {self.unit}".rstrip()


class ExactField(PhysicalField):
    """A measured value of more steps, or larger whole numbers, than floats tell apart.

    It holds an int where all its values are whole numbers. A float that stands for several raw
    values is refused, as the lowest bits would be lost; a Decimal or a Fraction is exact.
    """

    __slots__ = ()

    def to_raw(self, message: str, value: object) -> int:
        """The raw value to send; raises `EncodeError`."""
        if type(value) is SignalState:
            return self._state(message, value)
        number, signal, given = self._number(message, value), self.signal, exact_number(value)
        raw = round((given - Fraction(signal.offset)) / Fraction(signal.factor))
        least, most = signal.sendable
        inside = min(max(raw, least), most)
        if raw != inside and (given != number or self._physical(inside) != number):
            raise self._refuse(message, value, self._outside(number))
        if isinstance(value, float):
            near = {self._physical(each): each for each in (inside - 1, inside, inside + 1)}
            if len(near) < 3:
                problem = f"{value!r} stands for several raw values: give a Decimal"
                raise self._refuse(message, value, problem)
            inside = near.get(value, inside)
        if inside in self.states:
            raise self._refuse(message, value, f"raw {inside} means {self.states[inside]}")
        return inside

    def _physical(self, raw: int) -> float:
        return raw * self.factor + self.offset

    def text(self, value: Value) -> str:
        """The value with its unit, a whole number with all its digits."""
        whole = isinstance(value, int)
        return f"{value} {self.unit}".rstrip() if whole else PhysicalField.text(self, value)


class FloatField(PhysicalField):
    """A measured value that its frames carry as a float, not as a number of steps."""

    __slots__ = ()

    def to_raw(self, message: str, value: object) -> Any:
        """The raw value to send, a float; raises `EncodeError`."""
        if type(value) is SignalState:
            return self._state(message, value)
        number = value if type(value) is float else self._number(message, value)
        if not self.minimum <= number <= self.maximum:
            raise self._refuse(message, value, self._outside(number))
        raw = (number - self.offset) / self.factor
        if not self._has_room(raw):
            problem = f"{number:g} has no room in a float of {self.length} bits"
            raise self._refuse(message, value, problem)
        return raw

    def _has_room(self, raw: float) -> bool:
        try:
            struct.pack(_SHORT_FLOATS.get(self.length, "<d"), raw)
        except OverflowError:
            return False
        return math.isfinite(raw)


class NumberField(Field):
    """A whole number: a count, an index, a code of the manufacturer's.

    It takes ints, also numpy's, and a Decimal without a fraction; no float, not even 5.0.
    """

    __slots__ = ()

    def to_raw(self, message: str, value: object) -> int:
        """The raw value to send; raises `EncodeError`."""
        if type(value) is SignalState:
            return self._state(message, value)
        number = value if type(value) is int else whole_number(value)
        if number is None:
            problem = f"expected a whole number, {self._limits()}, not {shown(value)}"
            raise self._refuse(message, value, problem)
        if not self.minimum <= number <= self.maximum:
            problem = f"{shown(number)} is out of range; allowed are {self._limits()}"
            raise self._refuse(message, value, problem)
        if number in self.states:
            raise self._refuse(message, value, f"{number} means {self.states[number]}")
        return number


@dataclass(frozen=True, slots=True, kw_only=True)
class LabelledField(Field):
    """One of a few codes, as a member of ``enum`` or an int, also numpy's; never another enum.

    A code without a label is a plain int. An enum of another signal may have the same code for
    the opposite, and so may a bool: both are refused.
    """

    enum: type[IntEnum]

    def to_raw(self, message: str, value: Any) -> int:
        """The raw value to send; raises `EncodeError`."""
        kind = type(value)
        code = value if kind is self.enum or kind is int else integer(value)
        if code is None or not self.minimum <= code <= self.maximum:
            name = self.enum.__name__
            problem = f"{shown(value)} is no {name}: expected {name} or a code {self._limits()}"
            raise self._refuse(message, value, problem)
        return code

    def text(self, value: Value) -> str:
        """The label of the code, or the code where it has none."""
        return self.labels.get(int(value), str(value)) if isinstance(value, int) else str(value)


class CharacterField(Field):
    """One ASCII character; a code that the standard gives no character is a plain int."""

    __slots__ = ()

    def to_raw(self, message: str, value: object) -> int:
        """The raw value to send; raises `EncodeError`."""
        if type(value) is SignalState:
            return self._state(message, value)
        kind = type(value)
        given: object = value
        if kind is not str and kind is not int:
            given = character(value) or integer(value)
        if isinstance(given, str) and len(given) == 1 and self.labels.get(ord(given)) == given:
            return ord(given)
        least = -1 << self.length - 1 if self.signal.signed else 0
        if isinstance(given, int) and least <= given < least + (1 << self.length):
            return given
        known = "".join(self.labels.values())
        problem = f"{shown(value)} is none of the characters {known} and no code {self._limits()}"
        raise self._refuse(message, value, problem)

    def text(self, value: Value) -> str:
        """The character, or the code where it is none."""
        return f"0x{value % (1 << self.length):02X}" if isinstance(value, int) else str(value)


class FilledField(NumberField):
    """A checksum or counter: None until it is sent, then filled in."""

    __slots__ = ()

    def to_raw(self, message: str, value: object) -> int:
        """The raw value to send, 0 where it is to be filled in; raises `EncodeError`."""
        return 0 if value is None else NumberField.to_raw(self, message, value)
