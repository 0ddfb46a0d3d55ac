"""Typed messages to payloads and back, with cantools packing the bits."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from itertools import chain
from typing import Any, overload

import can

from typedcan.model.checksums.registry import Given
from typedcan.model.editions import edition_of, unsure_codes
from typedcan.model.j1939 import sent_identifier
from typedcan.model.protocol import FD_LENGTHS, LONGEST_CLASSIC
from typedcan.model.seal import seals_of
from typedcan.wire.database import Database, database
from typedcan.wire.errors import (
    DecodeError,
    SendingError,
    UnknownFrameError,
    UnknownMessageError,
)
from typedcan.wire.message import Message, MessageT
from typedcan.wire.protocol import Protocol
from typedcan.wire.reader import Reader
from typedcan.wire.writer import Writer


class Codec:
    """Encodes and decodes the messages of the protocol.

    Parameters
    ----------
    protocol
        Whose messages, as a package that `dbcspec generate` wrote has it, or `typed_protocol`; can
        be read again.
    algorithms
        By the names that the protocol has for checksum algorithms, what computes those that are not
        known here, for example ``{"Status_CRC": my_crc}``: a function from the covered bytes to an
        int, or a name that is known. A checksum that the standard leaves open is sent as 0 without
        one, and not verified; a message with another one is not sent.

    accelerated
        Whether generated functions may move the bits, which do the same as cantools' formats: the
        generator has held them against each other.

    ``unsure`` has what stands in for safe codes that editions disagree about, none where one was
    chosen: see `unsure_codes`.

    Raises
    ------
    AlgorithmError
        No message has an algorithm of a name that is given, or what is given is none.
    """

    def __init__(
        self,
        protocol: Protocol,
        algorithms: Given | None = None,
        *,
        accelerated: bool = True,
    ) -> None:
        self.protocol = protocol
        self._seals = seals_of(protocol.model.messages, algorithms or {})
        self._accelerated = accelerated
        self.unsure = {} if edition_of(protocol.model) else unsure_codes(protocol.model)
        self._writers: dict[type[Message], Writer] = {}

    @cached_property
    def _database(self) -> Database:
        return database(self.protocol)

    @cached_property
    def _by_type(self) -> Mapping[type[Message], Reader]:
        entries = self._database.by_type
        return {
            kind: Reader(each, self._seals.get(kind.NAME), accelerated=self._accelerated)
            for kind, each in entries.items()
        }

    @cached_property
    def readers(self) -> Mapping[int, Reader]:
        """What checks and decodes the payloads of each message with a 29-bit identifier."""
        entries = self._database.extended.items()
        return {number: self._by_type[entry.type] for number, entry in entries}

    @cached_property
    def standard_readers(self) -> Mapping[int, Reader]:
        """The same for 11-bit identifiers: one number in both widths is two messages."""
        entries = self._database.standard.items()
        return {number: self._by_type[entry.type] for number, entry in entries}

    def reader_by_pgn(self, frame_id: int) -> Reader | None:
        """The same for the PGN of an identifier; None where no message is matched by it."""
        entry = self._database.by_pgn.find(frame_id)
        return self._by_type[entry.type] if entry else None

    def kind(self, frame_id: int, *, extended: bool) -> type[Message] | None:
        """The message class of an identifier of that width, or of its PGN, if there is one."""
        entry = self._database.entry(frame_id, extended=extended)
        return entry.type if entry else None

    def reader(self, kind: type[Message]) -> Reader:
        """The same for a message class; raises `UnknownMessageError`."""
        reader = self._by_type.get(kind)
        if reader is None:
            name = getattr(kind, "NAME", kind)
            raise UnknownMessageError(f"{name} is no message class of {self.protocol.name}")
        return reader

    @property
    def bare(self) -> Codec:
        """What encodes and decodes the classes of what is spoken, where those are others."""
        return self

    def said(self, message: Message) -> Message:
        """The message in the class of what is spoken: itself, where nothing else was chosen."""
        return message

    def encode(
        self,
        message: Message,
        *,
        counter: int | None = None,
        renew: bool = False,
        safe: bool = False,
    ) -> bytes:
        """The payload of a message.

        ``counter`` goes into its alive counter. A checksum or counter that the message itself
        has is sent as it is; where it is None the checksum is computed, and the counter its first.
        With ``renew`` the checksum is always computed: a message that was received and is sent
        again has the old one. With ``safe`` signals with codes that act get their safe code,
        whatever the message has. Raises `EncodeError` for a value that cannot be sent.
        """
        writer = self._writers.get(type(message)) or self._writer(type(message))
        instead = self.unsure.get(message.NAME, {}) if safe else None
        return writer.payload(message, counter, renew=renew, safe=instead)

    def _writer(self, kind: type[Message]) -> Writer:
        entry = self.reader(kind).entry
        seal = self._seals.get(kind.NAME)
        self._writers[kind] = Writer(entry, seal, accelerated=self._accelerated)
        return self._writers[kind]

    def frame(
        self,
        message: Message,
        *,
        counter: int | None = None,
        safe: bool = False,
        source_address: int | None = None,
        destination: int | None = None,
    ) -> can.Message:
        """The frame that a message is sent in: its payload as `encode` makes it with ``renew``.

        What a CAN FD payload lacks to a length that its frames can have is filled up with 0. The
        addresses count as `sent_identifier` has it; without a source that of its sender is meant.
        Raises `EncodeError`, and `SendingError` for a payload that no frame carries.
        """
        kind = type(message)
        model = kind.MODEL
        data = self.encode(message, counter=counter, renew=True, safe=safe)
        if source_address is None:
            source_address = self._database.by_type[kind].source_address
        most = FD_LENGTHS[-1] if model.is_fd else LONGEST_CLASSIC
        if len(data) > most:
            sort = "CAN FD" if model.is_fd else "classic CAN"
            raise SendingError(f"{kind.NAME}: no frame of {sort} carries {len(data)} bytes")
        return can.Message(
            arbitration_id=sent_identifier(model, source_address, destination),
            is_extended_id=kind.EXTENDED,
            is_fd=model.is_fd,
            bitrate_switch=model.bit_rate_switch,
            data=data.ljust(model.frame_length, b"\0") if model.is_fd else data,
            is_rx=False,
        )

    @overload
    def decode(
        self, frame_id: int, data: bytes, *, verify: bool = True, extended: bool | None = None
    ) -> Message: ...
    @overload
    def decode(self, frame_id: type[MessageT], data: bytes, *, verify: bool = True) -> MessageT: ...
    def decode(
        self,
        frame_id: int | type[Message],
        data: bytes,
        *,
        verify: bool = True,
        extended: bool | None = None,
    ) -> Any:
        """The message in the payload of a frame with an identifier, or of a message class.

        ``extended`` says whether the identifier has 29 bits or 11; without it that of 29 bits is
        meant where the protocol has both. Raises `UnknownFrameError` for an identifier that it has
        not, `DecodeError` for such a class, `LengthError` for a payload of another length, and
        `ChecksumError`, unless ``verify`` is False.
        """
        reader = self._known.get(frame_id) if extended is None else None
        if reader is None:
            reader = self._find(frame_id, data, extended=extended)
        if len(data) != reader.length or (verify and reader.verify and not reader.verify(data)):
            data = reader.payload(data, verify=verify)
        return reader.decode(data)

    @cached_property
    def _known(self) -> Mapping[int | type[Message], Reader]:
        """By what a message is asked for where no width of the identifier is given."""
        readers = (self.standard_readers, self.readers, self._by_type)
        return dict(chain.from_iterable(each.items() for each in readers))

    def _find(self, frame_id: int | type[Message], data: bytes, *, extended: bool | None) -> Reader:
        if isinstance(frame_id, type):
            try:
                return self.reader(frame_id)
            except UnknownMessageError as error:
                raise DecodeError(getattr(frame_id, "FRAME_ID", 0), data, str(error)) from None
        reader = None if extended is False else self.readers.get(frame_id)
        if reader is None and not extended:
            reader = self.standard_readers.get(frame_id)
        if reader is None and extended is not False:
            reader = self.reader_by_pgn(frame_id)
        if reader is None:
            raise UnknownFrameError(frame_id, "no message of the protocol has this identifier")
        return reader

    def decode_frame(self, frame: can.Message, *, verify: bool = True) -> Message:
        """The message in a frame of python-can; raises as `decode`.

        Error frames and remote frames are unknown frames, whatever their number.
        """
        if reason := self._refusal(frame):
            raise UnknownFrameError(frame.arbitration_id, reason)
        data, extended = bytes(frame.data), frame.is_extended_id
        return self.decode(frame.arbitration_id, data, verify=verify, extended=extended)

    def _refusal(self, frame: can.Message) -> str | None:
        """Why a frame carries no message, whatever its number."""
        if frame.is_error_frame:
            return "is an error frame"
        if frame.is_remote_frame:
            return "is a remote frame, it carries no data"
        if not frame.is_extended_id and not self.standard_readers:
            return "has an 11-bit identifier, the protocol has 29-bit ones"
        return None
