"""Raw values to payload bytes and back, by the bit formats that cantools compiles.

cantools' own ``encode`` and ``decode`` do per call what the generated classes already know:
they look signals up, scale and check. Its compiled formats are the part that moves the bits.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import reduce
from operator import itemgetter, or_
from typing import Any, NamedTuple

from cantools.database.conversion import BaseConversion
from cantools.database.utils import create_encode_decode_formats

from typedcan.model import layout
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

    The signals stand in the order of their bits. cantools' formats hold each bit once: signals that
    share bits, as those of branches do, are moved by packers of their own.
    """

    def __init__(self, signals: Sequence[Signal], length: int, filler: int = 0) -> None:
        own, *others = _apart(signals) or [[]]
        bits: Any = [_bits(signal) for signal in own]
        formats = create_encode_decode_formats(bits, length)
        names = [signal.name for signal in signals]
        orders = {signal.byte_order for signal in own}
        self._length, self._filler = length, filler
        self._big: Any = formats.big_endian if ByteOrder.MOTOROLA in orders else None
        self._little: Any = formats.little_endian if ByteOrder.INTEL in orders else None
        self._pick: Any = itemgetter(*names) if len(names) > 1 else lambda raw: tuple(raw.values())
        self._others = [Packer(each, length) for each in others]
        self._zeros = dict.fromkeys(names, 0) if any(each.selectors for each in signals) else None

    def unpack(self, data: bytes) -> Sequence[int]:
        """The raw values in the order of the message's signals; ``data`` has its full length."""
        values: Sequence[int] = self._pick(self._unpack(data))
        return values

    def _unpack(self, data: bytes) -> dict[str, int]:
        if not self._little:
            raw: dict[str, int] = self._big.unpack(data) if self._big else {}
        else:
            raw = self._little.unpack(data[::-1])
            if self._big:
                raw.update(self._big.unpack(data))
        for other in self._others:
            raw |= other._unpack(data)  # noqa: SLF001 - of its own kind
        return raw

    def pack(self, raw: Mapping[str, int]) -> bytes:
        """The payload; ``raw`` has a value for every signal that is there, other bits are fillers.

        Raises `ValueError` with the name of a signal whose bits another one needs otherwise.
        """
        data = self._pack(raw)
        if self._others:
            again = self._unpack(data)
            for name, value in raw.items():
                if again[name] != value and isinstance(value, int):
                    raise ValueError(name)
        if self._filler:
            data = (int.from_bytes(data, "little") | self._filler).to_bytes(self._length, "little")
        return data

    def _pack(self, raw: Mapping[str, int]) -> bytes:
        if self._zeros:
            raw = {**self._zeros, **raw}
        parts = [self._little.pack(raw)[::-1]] if self._little else []
        parts += [self._big.pack(raw)] if self._big else []
        parts += [other._pack(raw) for other in self._others]  # noqa: SLF001 - of its own kind
        if len(parts) == 1:
            payload: bytes = parts[0]
            return payload
        return reduce(or_, (int.from_bytes(part) for part in parts), 0).to_bytes(self._length)


def _apart(signals: Sequence[Signal]) -> list[list[Signal]]:
    """The signals in groups within which no two share a bit."""
    groups: list[tuple[set[int], list[Signal]]] = []
    for signal in signals:
        taken = set(layout.bits(signal))
        group = next((each for each in groups if each[0].isdisjoint(taken)), None)
        if group is None:
            groups.append(group := (set(), []))
        group[0].update(taken)
        group[1].append(signal)
    return [members for _, members in groups]


def packer_of(message: Message) -> Packer:
    """What packs all signals of a message, in the order of their bits."""
    return Packer(layout.readable(message), message.length, layout.filler(message))


def _bits(signal: Signal) -> _Bits:
    return _Bits(
        name=signal.name,
        start=signal.start,
        length=signal.length,
        byte_order="little_endian" if signal.byte_order is ByteOrder.INTEL else "big_endian",
        is_signed=signal.signed,
        conversion=BaseConversion.factory(is_float=signal.is_float),
    )
