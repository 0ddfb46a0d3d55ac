"""What comes in: the frames of a bus checked and counted, and decoded once they are read."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Any, Generic, Literal

import can

from typedcan.model import j1939
from typedcan.wire.codec import Codec
from typedcan.wire.errors import LengthError
from typedcan.wire.message import Message, MessageT_co
from typedcan.wire.protect import CounterFault, ReceiveCounters
from typedcan.wire.reader import Reader

FaultKind = Literal["length", "checksum", "counter", "format"]

_new: Any = object.__new__


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


class Received(Generic[MessageT_co]):
    """A message, the frame that it came in, and what was wrong with counter or format, if anything.

    The message is decoded when it is read for the first time: many a frame is received only to be
    supervised, recorded or passed on.

    Attributes
    ----------
    kind
        The message class.
    data
        The payload, without what fills up a CAN FD frame.
    frame, faults
        The frame, and what was wrong.
    """

    __slots__ = ("_message", "data", "faults", "frame", "kind")

    def __init__(
        self, message: MessageT_co, frame: can.Message, faults: tuple[Fault, ...] = ()
    ) -> None:
        self.kind = type(message)
        self.data = bytes(frame.data)[: message.LENGTH]
        self.frame = frame
        self.faults = faults
        self._message: Any = message  # or the reader that will decode it

    @property
    def message(self) -> MessageT_co:
        """The message."""
        if type(self._message) is Reader:
            self._message = self._message.decode(self.data)
        message: MessageT_co = self._message
        return message

    @property
    def source_address(self) -> int | None:
        """The address of who sent it; None, as of the next two, unless it is matched by PGN."""
        return j1939.source_address(self.frame.arbitration_id) if self.kind.MODEL.by_pgn else None

    @property
    def destination(self) -> int | None:
        """The address of whom it is sent to; 255 for all."""
        return j1939.destination(self.frame.arbitration_id) if self.kind.MODEL.by_pgn else None

    @property
    def priority(self) -> int | None:
        """The priority in its identifier, 0 the highest."""
        return j1939.priority(self.frame.arbitration_id) if self.kind.MODEL.by_pgn else None

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
        Messages, those with a wrong counter or format among them.
    foreign
        Frames that are none of the protocol's.
    length, checksum
        Frames of known messages that were refused.
    counter, format
        Messages with a wrong counter, and those in frames of another format: classic CAN where the
        protocol says CAN FD, or the other way round. Their bits are those of the message.
    """

    received: int = 0
    foreign: int = 0
    length: int = 0
    checksum: int = 0
    counter: int = 0
    format: int = 0

    @property
    def faults(self) -> int:
        """All faults together."""
        return self.length + self.checksum + self.counter + self.format


class Receiver:
    """Decodes the frames of one bus in their order, checks and counts them; needs no bus itself."""

    def __init__(self, codec: Codec) -> None:
        self._extended = codec.readers
        self._standard = codec.standard_readers
        by_pgn = any(kind.MODEL.by_pgn for kind in codec.protocol.messages)
        self._by_pgn = codec.reader_by_pgn if by_pgn else None
        self._counters = ReceiveCounters()
        self._received = 0
        self._counts: Counter[str] = Counter()

    @property
    def counts(self) -> Counts:
        """A snapshot of the counts."""
        return Counts(self._received, **self._counts)

    def take(self, frame: can.Message) -> Received[Message] | Fault | None:
        """The message in a frame, or why a frame of a known message is refused.

        None for a foreign frame: an unknown identifier, a remote or an error frame.
        """
        readers = self._extended if frame.is_extended_id else self._standard
        reader = readers.get(frame.arbitration_id)
        if reader is None and self._by_pgn and frame.is_extended_id:
            reader = self._by_pgn(frame.arbitration_id)
        if reader is None or frame.is_error_frame or frame.is_remote_frame:
            self._counts["foreign"] += 1
            return None
        data = bytes(frame.data)
        if len(data) != reader.length:
            if len(data) != reader.frame_length:
                return self._refused(reader, data, frame)
            data = data[: reader.length]
        if reader.verify and not reader.verify(data):
            return self._refused(reader, data, frame)
        self._received += 1
        # What every frame passes through is kept short: no call of a constructor.
        received: Received[Message] = _new(Received)
        received.kind = reader.kind
        received.data = data
        received.frame = frame
        received._message = reader  # noqa: SLF001 - of this module
        received.faults = ()
        if reader.counter:
            counter = reader.counter(data)
            problem = self._counters.problem(reader.entry.type, counter, frame.arbitration_id)
            if problem is not None:
                fault = self._fault("counter", reader, problem.text, frame, problem.kind)
                received.faults = (fault,)
        if frame.is_fd == reader.other_format:
            text = "came in a CAN FD frame" if frame.is_fd else "came in a frame of classic CAN"
            received.faults += (self._fault("format", reader, text, frame),)
        return received

    def _refused(self, reader: Reader, data: bytes, frame: can.Message) -> Fault:
        """Why a frame of a known message is refused."""
        error = reader.refusal(data)
        kind: FaultKind = "length" if isinstance(error, LengthError) else "checksum"
        return self._fault(kind, reader, error.brief, frame)

    def _fault(
        self,
        kind: FaultKind,
        reader: Reader,
        text: str,
        frame: can.Message,
        counter: CounterFault | None = None,
    ) -> Fault:
        self._counts[kind] += 1
        return Fault(kind, reader.kind.NAME, text, frame, counter)
