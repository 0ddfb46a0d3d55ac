"""A signal in the model: where its bits lie, what they mean, and the codes of its value table."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from decimal import Decimal
from enum import Enum
from types import MappingProxyType

from typedcan.model.acting import ActingCodes, no_value
from typedcan.model.errors import Location
from typedcan.model.extras import Attribute
from typedcan.model.signal_state import SignalState

NOWHERE = Location("")


class ByteOrder(Enum):
    """How the bits of a signal follow each other."""

    INTEL = "Intel"
    MOTOROLA = "Motorola"


@dataclass(frozen=True, slots=True)
class Code:
    """One raw value with a meaning: the label as printed and in English."""

    value: int
    label: str
    english: str


@dataclass(frozen=True, slots=True)
class ValueTable:
    """The codes of one or more signals, ascending by value."""

    name: str
    codes: tuple[Code, ...]

    def labels(self, *, english: bool = True) -> dict[int, str]:
        """Raw value to label."""
        return {code.value: code.english if english else code.label for code in self.codes}


@dataclass(frozen=True, slots=True, kw_only=True)
class Signal:
    """A value in a message. Physical value = raw value x factor + offset.

    A multiplexed signal is there only while the signal ``multiplexer`` of its message, which has
    ``is_selector``, holds one of the raw values ``selectors``.
    """

    name: str
    title: str = ""
    english: str = ""
    start: int
    length: int
    byte_order: ByteOrder = ByteOrder.INTEL
    signed: bool = False
    is_float: bool = False
    factor: Decimal = Decimal(1)
    offset: Decimal = Decimal(0)
    minimum: Decimal
    maximum: Decimal
    unit: str = ""
    value_table: ValueTable | None = None
    invalid_code: int | None = None
    other_invalid_codes: tuple[int, ...] = ()
    abnormal_code: int | None = None
    start_value: int = 0
    acting: ActingCodes | None = None
    receivers: tuple[str, ...] = ()
    is_selector: bool = False
    multiplexer: str = ""
    selectors: tuple[int, ...] = ()
    python_name: str = ""
    attributes: tuple[Attribute, ...] = ()
    reference: str = ""
    errata: tuple[str, ...] = ()
    where: Location = field(default=NOWHERE, compare=False)

    @property
    def states(self) -> Mapping[int, SignalState]:
        """The raw values that are no value, and what they say.

        Several may say that it is invalid; ``invalid_code`` is the one that is sent.
        """
        pairs = (
            (self.invalid_code, SignalState.INVALID),
            (self.abnormal_code, SignalState.ABNORMAL),
            *((code, SignalState.INVALID) for code in self.other_invalid_codes),
        )
        return MappingProxyType({code: state for code, state in pairs if code is not None})

    @property
    def must_be_given(self) -> bool:
        """Whether what stands for no value, or the start value, is a code that acts."""
        acting = self.acting.codes if self.acting else ()
        return no_value(self.invalid_code) in acting or self.start_value in acting

    @property
    def raw_limits(self) -> tuple[int, int]:
        """The smallest and largest value that the bits can hold."""
        low = -(1 << (self.length - 1)) if self.signed else 0
        return low, low + (1 << self.length) - 1

    @property
    def raw_range(self) -> tuple[int, int]:
        """The raw values of minimum and maximum, in ascending order, rounded inwards.

        With a factor of 0, all that the bits can hold.
        """
        if not self.factor:
            return self.raw_limits
        low, high = sorted(
            ((self.minimum - self.offset) / self.factor, (self.maximum - self.offset) / self.factor)
        )
        return math.ceil(low), math.floor(high)

    @property
    def sendable(self) -> tuple[int, int]:
        """The raw values of its range that its bits can hold; all that they can where none is."""
        (low, high), (least, most) = self.raw_range, self.raw_limits
        low, high = max(low, least), min(high, most)
        return (low, high) if low <= high else (least, most)
