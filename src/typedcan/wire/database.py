"""What packs and unpacks each message of a protocol: formats made from the model, once."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, cached_property

from typedcan.model.j1939 import ByPgn, address_in
from typedcan.model.layout import bits_reader
from typedcan.model.protocol import Aspect
from typedcan.wire.decoding import decoder_of
from typedcan.wire.message import Message, StraightLine
from typedcan.wire.packing import Packer, packer_of
from typedcan.wire.protocol import Protocol


@dataclass(frozen=True)
class Entry:
    """A message class with what moves its bits.

    Parameters
    ----------
    straight
        Its generated functions, where there are some.
    counter
        Reads the alive counter alone, where there is one.
    is_fd
        Whether it has CAN FD frames, None where the protocol says nothing of formats.
    source_address
        Its sender's, on J1939.
    """

    type: type[Message]
    straight: StraightLine | None
    counter: Callable[[bytes], int] | None
    is_fd: bool | None
    source_address: int

    @cached_property
    def packer(self) -> Packer:
        """What packs and unpacks its signals; made when it is needed."""
        return packer_of(self.type.MODEL)

    @cached_property
    def decode(self) -> Callable[[bytes], Message]:
        """What makes a message of a payload, by cantools' formats."""
        unpack, make = self.packer.unpack, decoder_of(self.type)
        return lambda data: make(unpack(data))


@dataclass(frozen=True, slots=True)
class Database:
    """All messages, by class, by identifier, 29 bits and 11 bits apart, and by PGN."""

    by_type: Mapping[type[Message], Entry]
    extended: Mapping[int, Entry]
    standard: Mapping[int, Entry]
    by_pgn: ByPgn[Entry]

    def entry(self, frame_id: int, *, extended: bool) -> Entry | None:
        """Of the message that an identifier of that width is of, whole or by its PGN."""
        if not extended:
            return self.standard.get(frame_id)
        return self.extended.get(frame_id) or self.by_pgn.find(frame_id)


@cache
def database(protocol: Protocol) -> Database:
    """What packs and unpacks the messages of a protocol."""
    entries = [_entry(message, protocol) for message in protocol.messages]
    return Database(
        by_type={entry.type: entry for entry in entries},
        extended={each.type.FRAME_ID: each for each in entries if each.type.EXTENDED},
        standard={each.type.FRAME_ID: each for each in entries if not each.type.EXTENDED},
        by_pgn=ByPgn((each.type.MODEL, each) for each in entries),
    )


def _entry(message: type[Message], protocol: Protocol) -> Entry:
    counter = message.COUNTER and message.MODEL.signal(message.COUNTER.signal)
    return Entry(
        type=message,
        straight=protocol.codecs.get(message),
        counter=bits_reader(counter, message.LENGTH) if counter else None,
        is_fd=message.MODEL.is_fd if Aspect.FRAME_FORMATS in protocol.model.carries else None,
        source_address=address_in(protocol.model, message.SENDER),
    )
