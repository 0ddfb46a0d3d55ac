"""Raw values to payload bytes and back, by the bit formats that cantools compiles.

cantools' own ``encode`` and ``decode`` do per call what the generated classes already know:
they look signals up, scale and check. Its compiled formats are the part that moves the bits.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from operator import itemgetter
from typing import Any, Literal

from cantools.database.can import Message as CantoolsMessage
from cantools.database.utils import create_encode_decode_formats


class Packer:
    """Packs and unpacks the signals of one message, of either byte order or both.

    ``only`` are the signals to look at, by their DBC names; without it all.
    """

    def __init__(self, message: CantoolsMessage, only: Collection[str] | None = None) -> None:
        signals = [one for one in message.signals if only is None or one.name in only]
        formats = create_encode_decode_formats(signals, message.length)
        names = [signal.name for signal in signals]
        orders = {signal.byte_order for signal in signals}
        self._length = message.length
        self._big: Any = formats.big_endian if "big_endian" in orders else None
        self._little: Any = formats.little_endian if "little_endian" in orders else None
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
