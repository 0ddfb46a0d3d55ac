"""Raw values to payload bytes and back, by the bit formats that cantools compiles.

cantools' own ``encode`` and ``decode`` do per call what the generated classes already know:
they look signals up, scale and check. Its compiled formats are the part that moves the bits.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from operator import itemgetter
from typing import Any, Literal, NamedTuple

from cantools.database.conversion import BaseConversion
from cantools.database.utils import create_encode_decode_formats

from typedcan.model.layout import in_bit_order
from typedcan.model.protocol import ByteOrder, Message, Signal


class _Bits(NamedTuple):
    """A signal as far as cantools looks at it for its bit formats."""

    name: str
    start: int
    length: int
    byte_order: str
    is_signed: bool
    conversion: BaseConversion


class Packer:
    """Packs and unpacks signals of a message of so many bytes, of either byte order or both.

    The signals stand in the order of their bits.
    """

    def __init__(self, signals: Sequence[Signal], length: int) -> None:
        bits: Any = [_bits(signal) for signal in signals]
        formats = create_encode_decode_formats(bits, length)
        names = [signal.name for signal in signals]
        orders = {signal.byte_order for signal in signals}
        self._length = length
        self._big: Any = formats.big_endian if ByteOrder.MOTOROLA in orders else None
        self._little: Any = formats.little_endian if ByteOrder.INTEL in orders else None
        self._pick: Any = itemgetter(*names) if len(names) > 1 else lambda raw: tuple(raw.values())

    @property
    def byte_order(self) -> Literal["big", "little"]:
        """The order of bytes of most signals' numbers: little where both orders are mixed."""
        return "little" if self._little else "big"

    def unpack(self, data: bytes) -> Sequence[int]:
        """The raw values in the order of the message's signals; ``data`` has its full length."""
        if not self._little:
            raw = self._big.unpack(data)
        else:
            raw = self._little.unpack(data[::-1])
            if self._big:
                raw.update(self._big.unpack(data))
        values: Sequence[int] = self._pick(raw)
        return values

    def pack(self, raw: Mapping[str, int]) -> bytes:
        """The payload; ``raw`` has a value for every signal, bits without a signal are 0."""
        little: bytes = self._little.pack(raw)[::-1] if self._little else bytes(self._length)
        if not self._big:
            return little
        big: bytes = self._big.pack(raw)
        if not self._little:
            return big
        both = int.from_bytes(little, "big") | int.from_bytes(big, "big")
        return both.to_bytes(self._length, "big")


def packer_of(message: Message) -> Packer:
    """What packs all signals of a message, in the order of their bits."""
    return Packer(in_bit_order(message.signals), message.length)


def _bits(signal: Signal) -> _Bits:
    return _Bits(
        name=signal.name,
        start=signal.start,
        length=signal.length,
        byte_order="little_endian" if signal.byte_order is ByteOrder.INTEL else "big_endian",
        is_signed=signal.signed,
        conversion=BaseConversion.factory(is_float=signal.is_float),
    )
