"""Raw values to payload bytes and back, by the bit formats that cantools compiles.

cantools' own ``encode`` and ``decode`` do per call what the generated classes already know:
they look signals up, scale and check. Its compiled formats are the part that moves the bits.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from operator import itemgetter
from typing import Any

from cantools.database.can import Message as CantoolsMessage
from cantools.database.utils import create_encode_decode_formats


class Packer:
    """Packs and unpacks the signals of one message, of either byte order or both."""

    def __init__(self, message: CantoolsMessage) -> None:
        formats = create_encode_decode_formats(message.signals, message.length)
        names = [signal.name for signal in message.signals]
        orders = {signal.byte_order for signal in message.signals}
        self._length = message.length
        self._big: Any = formats.big_endian if "big_endian" in orders else None
        self._little: Any = formats.little_endian if "little_endian" in orders else None
        self._pick: Any = itemgetter(*names) if len(names) > 1 else lambda raw: tuple(raw.values())

    def unpack(self, data: bytes) -> Sequence[int]:
        """The raw values in the order of the message's signals; ``data`` has its full length."""
        raw: dict[str, Any] = {}
        if self._little:
            raw = self._little.unpack(data[::-1])
        if self._big:
            raw = {**raw, **self._big.unpack(data)}
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
