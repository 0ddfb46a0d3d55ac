"""How checksums are computed: CRCs, sums and XOR, over bytes or over columns of bytes at once.

The same code computes over the bytes of one payload, and over columns, of numpy say, that hold
the bytes of many.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property, reduce
from operator import or_, xor
from typing import Any

Algorithm = Callable[[bytes], int]
"""The covered bytes to a checksum, which the bits of its signal can hold."""

Pieces = Iterable[Any]
"""Bytes in their order, or columns of them."""


@dataclass(frozen=True, kw_only=True)
class Crc:
    """A CRC by the parameters of the public catalogue.

    ``refin`` and ``refout`` say whether bytes go in, and the result comes out, with their bits
    reflected.
    """

    width: int
    poly: int
    init: int = 0
    refin: bool = False
    refout: bool = False
    xorout: int = 0

    def __str__(self) -> str:
        """The parameters as the public catalogue writes them."""
        return (
            f"width={self.width} poly=0x{self.poly:X} init=0x{self.init:X}"
            f" refin={str(self.refin).lower()} refout={str(self.refout).lower()}"
            f" xorout=0x{self.xorout:X}"
        )

    def result_bits(self, bits: int) -> int:  # noqa: ARG002 - sums have those of their signal
        """How many bits results have."""
        return self.width

    @cached_property
    def table(self) -> tuple[int, ...]:
        """What each byte makes of an empty register; made once."""
        return tuple(map(self._shifted, range(256)))

    @cached_property
    def register_bits(self) -> int:
        """Of the register; one that is not reflected takes bytes in at its top."""
        return self.width if self.refin else max(self.width, 8)

    @cached_property
    def _begin(self) -> int:
        spare = self.register_bits - self.width
        return _reflected(self.init, self.width) if self.refin else self.init << spare

    def _shifted(self, byte: int) -> int:
        bits = self.register_bits
        if self.refin:
            poly, state = _reflected(self.poly, self.width), byte
            for _ in range(8):
                state = state >> 1 ^ (poly if state & 1 else 0)
            return state
        poly, state = self.poly << (bits - self.width), byte << (bits - 8)
        for _ in range(8):
            state = state << 1 ^ (poly if state >> (bits - 1) else 0)
            state &= (1 << bits) - 1
        return state

    def over(self, pieces: Pieces, table: Any) -> Any:
        """The result over bytes, or over columns with the table as a column, as a column.

        Columns have the type of that table: unsigned numbers of `register_bits` or more.
        """
        state: Any = self._begin
        if self.register_bits <= 8:
            for piece in pieces:
                state = table[state ^ piece]
        elif self.refin:
            for piece in pieces:
                state = state >> 8 ^ table[(state ^ piece) & 0xFF]
        else:
            top = self.register_bits - 8
            for piece in pieces:
                state = (state & (1 << top) - 1) << 8 ^ table[state >> top ^ piece]
        if self.refin != self.refout:
            state = _reflected(state, self.register_bits)
        elif not self.refin:
            state = state >> (self.register_bits - self.width)
        return state ^ self.xorout

    def function(self, bits: int) -> Algorithm:  # noqa: ARG002 - as above
        """What computes it for a signal of so many bits."""
        table = self.table
        return lambda data: self.over(data, table)


@dataclass(frozen=True, kw_only=True)
class Sum:
    """The sum of all bytes, or of their halves where ``unit`` is 4 bits.

    It is taken modulo ``modulus``, where that is 0 modulo what the bits of the signal can hold. The
    complement is what it lacks to the largest result (``ones``) or to the modulus (``twos``).
    """

    modulus: int = 0
    complement: str = ""
    unit: int = 8

    def __str__(self) -> str:
        facts = {"modulus": self.modulus, "complement": self.complement, "unit": self.unit % 8}
        return " ".join(["sum", *(f"{name}={value}" for name, value in facts.items() if value)])

    def result_bits(self, bits: int) -> int:
        """How many bits results have in a signal of so many."""
        return (self.modulus - 1).bit_length() if self.modulus else bits

    def over(self, pieces: Pieces, bits: int) -> Any:
        """The result over bytes, or over columns of signed 64 bits for at most 62, as a column."""
        modulus = self.modulus or 1 << bits
        total: Any = sum(_units(pieces, self.unit)) % modulus
        if self.complement == "ones":
            return modulus - 1 - total
        return (modulus - total) % modulus if self.complement else total

    def function(self, bits: int) -> Algorithm:
        """What computes it for a signal of so many bits."""
        return lambda data: self.over(data, bits)


@dataclass(frozen=True, kw_only=True)
class Xor:
    """The XOR of all bytes, or of their halves where ``unit`` is 4 bits."""

    unit: int = 8

    def __str__(self) -> str:
        return "xor" if self.unit == 8 else f"xor unit={self.unit}"

    def result_bits(self, bits: int) -> int:  # noqa: ARG002 - as above
        """How many bits results have."""
        return self.unit

    def over(self, pieces: Pieces) -> Any:
        """The result over bytes, or over columns of them, as a column."""
        return reduce(xor, _units(pieces, self.unit), 0)

    def function(self, bits: int) -> Algorithm:  # noqa: ARG002 - as above
        """What computes it for a signal of so many bits."""
        return _xor_of_bytes if self.unit == 8 else self.over


Method = Crc | Sum | Xor
"""An algorithm that is known here."""


def _xor_of_bytes(data: Iterable[int]) -> int:
    result = 0
    for byte in data:
        result ^= byte
    return result


def _units(pieces: Pieces, unit: int) -> Iterator[Any]:
    for piece in pieces:
        if unit == 4:
            yield piece >> 4
        yield piece & 0xF if unit == 4 else piece


def _reflected(value: Any, bits: int) -> Any:
    return reduce(or_, ((value >> bit & 1) << (bits - 1 - bit) for bit in range(bits)))
