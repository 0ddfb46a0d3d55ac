"""What packs and unpacks each message of a protocol: formats made from the model, once."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache

from typedcan.model.layout import bits_reader
from typedcan.model.protocol import Aspect
from typedcan.wire.message import Message
from typedcan.wire.packing import Packer, packer_of
from typedcan.wire.protocol import Protocol

Decoder = Callable[[Sequence[int]], Message]
"""Raw values, in the order of the class's ``FIELDS``, to a message."""


@dataclass(frozen=True, slots=True)
class Entry:
    """A message class with what packs its bits and what makes it from raw values.

    ``counter`` reads the alive counter alone, where there is one; ``is_fd`` says that it has CAN FD
    frames, None where the protocol says nothing of formats.
    """

    type: type[Message]
    packer: Packer
    decode: Decoder
    counter: Callable[[bytes], int] | None
    is_fd: bool | None


@dataclass(frozen=True, slots=True)
class Database:
    """All messages, by class and by identifier: 29 bits and 11 bits apart."""

    by_type: Mapping[type[Message], Entry]
    extended: Mapping[int, Entry]
    standard: Mapping[int, Entry]

    def entry(self, frame_id: int, *, extended: bool) -> Entry | None:
        """Of the message with an identifier of that width, if there is one."""
        return (self.extended if extended else self.standard).get(frame_id)


@cache
def database(protocol: Protocol) -> Database:
    """What packs and unpacks the messages of a protocol."""
    entries = [_entry(message, protocol) for message in protocol.messages]
    return Database(
        by_type={entry.type: entry for entry in entries},
        extended={each.type.FRAME_ID: each for each in entries if each.type.EXTENDED},
        standard={each.type.FRAME_ID: each for each in entries if not each.type.EXTENDED},
    )


def _entry(message: type[Message], protocol: Protocol) -> Entry:
    counter = message.COUNTER and message.MODEL.signal(message.COUNTER.signal)
    return Entry(
        type=message,
        packer=packer_of(message.MODEL),
        decode=protocol.decoders[message],
        counter=bits_reader(counter, message.LENGTH) if counter else None,
        is_fd=message.MODEL.is_fd if Aspect.FRAME_FORMATS in protocol.model.carries else None,
    )
