"""The errors of the runtime: each carries the facts as fields, and one line a person can act on."""

from __future__ import annotations

from typedcan.model.errors import TypedcanError


class EncodeError(TypedcanError, ValueError):
    """A value cannot be sent: ``message`` and ``field`` name it, ``value`` is what was given."""

    def __init__(self, message: str, field: str, value: object, problem: str) -> None:
        self.message = message
        self.field = field
        self.value = value
        self.problem = problem
        super().__init__(f"{message}.{field}: {problem}")


class DecodeError(TypedcanError, ValueError):
    """A frame cannot be decoded: ``frame_id`` and ``data`` are the frame's."""

    def __init__(self, frame_id: int, data: bytes, problem: str) -> None:
        self.frame_id = frame_id
        self.data = data
        self.problem = problem
        super().__init__(f"frame 0x{frame_id:08X} [{data.hex(' ').upper()}]: {problem}")


class LengthError(DecodeError):
    """A frame of a known message has not the length that the message has.

    ``brief`` says so in a few words.
    """

    def __init__(self, frame_id: int, data: bytes, message: str, expected: int) -> None:
        self.brief = f"{len(data)} bytes instead of {expected}"
        self.message = message
        self.expected = expected
        problem = f"{message} has {expected} bytes, the frame has {len(data)}"
        super().__init__(frame_id, data, problem)


class ChecksumError(DecodeError):
    """A frame carries another checksum than its bytes have; ``brief`` says so in a few words."""

    def __init__(
        self, frame_id: int, data: bytes, message: str, *, received: int, expected: int
    ) -> None:
        self.message = message
        self.brief = f"checksum is 0x{received:02X}, the bytes make 0x{expected:02X}"
        self.received = received
        self.expected = expected
        problem = f"{message} has checksum 0x{received:02X}, its bytes make 0x{expected:02X}"
        super().__init__(frame_id, data, problem)


class UnknownFrameError(TypedcanError, LookupError):
    """A frame is none of the protocol's messages; ``frame_id`` and ``reason`` say which and why."""

    def __init__(self, frame_id: int, reason: str) -> None:
        self.frame_id = frame_id
        self.reason = reason
        super().__init__(f"frame 0x{frame_id:X}: {reason}")


class UnknownMessageError(TypedcanError, LookupError):
    """There is no message of that name."""


class UnknownNodeError(TypedcanError, LookupError):
    """There is no node of that name."""


class ReceiveTimeoutError(TypedcanError, TimeoutError):
    """No message of the protocol arrived in ``timeout`` seconds."""

    def __init__(self, timeout: float) -> None:
        self.timeout = timeout
        super().__init__(f"no message within {timeout:g} s")


class SendingError(TypedcanError, ValueError):
    """A message that a node may not send, or cannot send in the way it was asked to."""
