"""The payloads of one message: checked as bytes, and decoded if anybody wants to know."""

from __future__ import annotations

from typedcan.model.seal import Seal
from typedcan.wire.database import Entry
from typedcan.wire.errors import ChecksumError, LengthError


class Reader:
    """Checks and decodes the payloads of one message.

    ``counter`` reads the alive counter in a payload of full length, where there is one.

    Parameters
    ----------
    entry
        The message.
    seal
        What makes the checksum; without it none is verified.
    accelerated
        Whether a generated function may decode.

    Attributes
    ----------
    decode
        Makes the message of a payload of full length: there is none that cannot be decoded.
    entry, kind, length, frame_length
        What was given, the message class, the bytes that a payload must have, and those of a
        filled-up frame.
    other_format
        Whether it is a CAN FD frame that would be one of another format; None where none is.
    verify, counter
        What tells whether the checksum in a payload of that length is right, and what reads its
        alive counter; None where there is none, or none that can be verified.
    """

    __slots__ = (
        "_seal",
        "counter",
        "decode",
        "entry",
        "frame_length",
        "kind",
        "length",
        "other_format",
        "verify",
    )

    def __init__(self, entry: Entry, seal: Seal | None, *, accelerated: bool) -> None:
        self.entry = entry
        self.kind = kind = entry.type
        straight = entry.straight if accelerated else None
        self.decode = straight.decode if straight else entry.decode
        self.length, self.frame_length = kind.LENGTH, kind.MODEL.frame_length
        self.other_format = None if entry.is_fd is None else not entry.is_fd
        self.counter = entry.counter
        self._seal = seal
        self.verify = seal.verify if seal else None

    def payload(self, data: bytes, *, verify: bool = True) -> bytes:
        """The payload in the bytes of a frame, without those that fill a CAN FD frame up.

        Raises `LengthError`, and `ChecksumError` unless ``verify`` is False.
        """
        if len(data) == self.frame_length:
            data = data[: self.length]
        if len(data) != self.length or (verify and self.verify and not self.verify(data)):
            raise self.refusal(data)
        return data

    def refusal(self, data: bytes) -> LengthError | ChecksumError:
        """Why a payload is refused, with a wrong length or else a wrong checksum."""
        kind, seal = self.kind, self._seal
        if len(data) != self.length or not seal:
            return LengthError(kind.FRAME_ID, data, kind.NAME, self.length)
        received, expected = seal.read(data), seal.expected(data)
        return ChecksumError(kind.FRAME_ID, data, kind.NAME, received=received, expected=expected)
