"""The payloads of one message: checked as bytes, and decoded if anybody wants to know."""

from __future__ import annotations

from collections.abc import Mapping

from typedcan.wire.database import Entry
from typedcan.wire.errors import ChecksumError, LengthError
from typedcan.wire.message import Message
from typedcan.wire.protect import Algorithm

_KEPT = 256
"""How many messages are kept: as many as a counter of a byte has values."""


class Reader:
    """Checks and decodes the payloads of one message.

    Parameters
    ----------
    entry
        The message.
    algorithms
        Checksum algorithms by name; a checksum of another one is not verified.
    """

    __slots__ = (
        "_algorithm",
        "_checksum",
        "_counter",
        "_covered",
        "_decode",
        "_decoded",
        "_length",
        "_unpack",
        "kind",
    )

    def __init__(self, entry: Entry, algorithms: Mapping[str, Algorithm]) -> None:
        self.kind = kind = entry.type
        self._unpack = entry.packer.unpack
        self._decode = entry.decode
        self._decoded: dict[bytes, Message] = {}
        self._length = kind.LENGTH
        self._counter = entry.counter
        checksum = kind.CHECKSUM
        self._algorithm = algorithms.get(checksum.algorithm) if checksum else None
        self._checksum = checksum.byte if checksum else 0
        self._covered = slice(checksum.first_byte, checksum.last_byte + 1) if checksum else slice(0)

    def check(self, data: bytes, *, verify: bool = True) -> None:
        """Raise `LengthError`, or `ChecksumError` unless ``verify`` is False."""
        if len(data) != self._length:
            raise LengthError(self.kind.FRAME_ID, data, self.kind.NAME, self._length)
        if self._algorithm and verify:
            expected, received = self._algorithm(data[self._covered]), data[self._checksum]
            if received != expected:
                kind = self.kind
                raise ChecksumError(
                    kind.FRAME_ID, data, kind.NAME, received=received, expected=expected
                )

    def counter(self, data: bytes) -> int | None:
        """The alive counter in a payload of full length; None where the message has none."""
        return self._counter.unpack(data)[0] if self._counter else None

    def decode(self, data: bytes) -> Message:
        """The message in a payload of full length: there is none that cannot be decoded.

        What was decoded is kept, as most frames on a bus say what was said before.
        """
        message = self._decoded.get(data)
        if message is None:
            if len(self._decoded) >= _KEPT:
                self._decoded.clear()
            message = self._decoded[data] = self._decode(self._unpack(data))
        return message
