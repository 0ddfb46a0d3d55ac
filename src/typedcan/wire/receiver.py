"""What comes in: the frames of a bus checked and counted, and decoded once they are read."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Literal

import can

from typedcan.wire.codec import Codec
from typedcan.wire.errors import ChecksumError, LengthError
from typedcan.wire.message import Message
from typedcan.wire.protect import CounterFault, ReceiveCounters
from typedcan.wire.reader import Reader

FaultKind = Literal["length", "checksum", "counter"]


@dataclass(frozen=True, slots=True)
class Fault:
    """Something wrong with a frame that has the identifier of a known message.

    ``message`` is the name of the message, ``text`` says what is wrong in a few words, and
    ``counter`` how the counter is wrong where ``kind`` is "counter".
    """

    kind: FaultKind
    message: str
    text: str
    frame: can.Message
    counter: CounterFault | None = None

    def __str__(self) -> str:
        return f"{self.message}: {self.text}"


class Received:
    """A message, the frame that it came in, and what was wrong with its counter, if anything.

    The message is decoded when it is read for the first time: many a frame is received only to be
    supervised, recorded or passed on.

    Attributes
    ----------
    kind
        The message class.
    data
        The payload as it came.
    frame, faults
        The frame, and what was wrong.
    """

    __slots__ = ("_message", "data", "faults", "frame", "kind")

    def __init__(
        self, message: Message, frame: can.Message, faults: tuple[Fault, ...] = ()
    ) -> None:
        self.kind = type(message)
        self.data = bytes(frame.data)
        self.frame = frame
        self.faults = faults
        self._message: Message | Reader = message

    @classmethod
    def undecoded(
        cls, reader: Reader, data: bytes, frame: can.Message, faults: tuple[Fault, ...] = ()
    ) -> Received:
        """The message in a payload that its reader has checked."""
        received = cls.__new__(cls)
        received.kind = reader.kind
        received.data = data
        received.frame = frame
        received.faults = faults
        received._message = reader  # noqa: SLF001
        return received

    @property
    def message(self) -> Message:
        """The message."""
        message = self._message
        if isinstance(message, Reader):
            message = self._message = message.decode(self.data)
        return message

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Received):
            return NotImplemented
        mine = (self.message, self.frame, self.faults)
        return mine == (other.message, other.frame, other.faults)

    def __hash__(self) -> int:
        return hash((self.message, self.frame, self.faults))

    def __repr__(self) -> str:
        return f"Received({self.message!r}, {self.frame!r}, {self.faults!r})"


@dataclass(frozen=True, slots=True)
class Counts:
    """How many frames came in so far, by what became of them.

    Parameters
    ----------
    received
        Messages, those with a wrong counter among them.
    foreign
        Frames that are none of the protocol's.
    length, checksum
        Frames of known messages that were refused.
    counter
        Messages with a wrong counter.
    """

    received: int = 0
    foreign: int = 0
    length: int = 0
    checksum: int = 0
    counter: int = 0

    @property
    def faults(self) -> int:
        """All faults together."""
        return self.length + self.checksum + self.counter


class Receiver:
    """Decodes the frames of one bus in their order, checks and counts them; needs no bus itself."""

    def __init__(self, codec: Codec) -> None:
        self._extended = codec.readers
        self._standard = codec.standard_readers
        self._counters = ReceiveCounters()
        self._received = 0
        self._counts: Counter[str] = Counter()

    @property
    def counts(self) -> Counts:
        """A snapshot of the counts."""
        return Counts(self._received, **self._counts)

    def take(self, frame: can.Message) -> Received | Fault | None:
        """The message in a frame, or why a frame of a known message is refused.

        None for a foreign frame: an unknown identifier, a remote or an error frame.
        """
        readers = self._extended if frame.is_extended_id else self._standard
        reader = readers.get(frame.arbitration_id)
        if reader is None or frame.is_error_frame or frame.is_remote_frame:
            self._counts["foreign"] += 1
            return None
        data = bytes(frame.data)
        try:
            reader.check(data)
        except LengthError as error:
            text = f"{len(error.data)} bytes instead of {error.expected}"
            return self._fault("length", error.message, text, frame)
        except ChecksumError as error:
            text = f"checksum is 0x{error.received:02X}, the bytes make 0x{error.expected:02X}"
            return self._fault("checksum", error.message, text, frame)
        self._received += 1
        counter = reader.counter(data)
        problem = None if counter is None else self._counters.problem(reader.kind, counter)
        if problem is None:
            return Received.undecoded(reader, data, frame)
        self._counts["counter"] += 1
        fault = Fault("counter", reader.kind.NAME, problem.text, frame, problem.kind)
        return Received.undecoded(reader, data, frame, (fault,))

    def _fault(self, kind: FaultKind, message: str, text: str, frame: can.Message) -> Fault:
        self._counts[kind] += 1
        return Fault(kind, message, text, frame)
