"""The packaged DBC, read once by cantools and matched with the generated classes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources

import cantools
from cantools.database.can import Database as CantoolsDatabase

from typedcan.wire.errors import DatabaseError
from typedcan.wire.message import Message
from typedcan.wire.packing import Packer
from typedcan.wire.protocol import Protocol

Decoder = Callable[[Sequence[int]], Message]
"""Raw values, in the order of the class's ``FIELDS``, to a message."""


@dataclass(frozen=True, slots=True)
class Entry:
    """A message class with what packs its bits and what makes it from raw values.

    ``counter`` unpacks the alive counter alone, where there is one.
    """

    type: type[Message]
    packer: Packer
    decode: Decoder
    counter: Packer | None


@dataclass(frozen=True, slots=True)
class Database:
    """All messages, by class and by 29-bit identifier."""

    by_type: Mapping[type[Message], Entry]
    by_frame_id: Mapping[int, Entry]


def dbc_text(protocol: Protocol) -> str:
    """The text of the DBC that a protocol's package was built with."""
    return resources.files(protocol.package).joinpath(_dbc_name(protocol)).read_text("ascii")


@cache
def database(protocol: Protocol) -> Database:
    """Read the packaged DBC; raises `DatabaseError` where it does not fit the generated code."""
    return match(dbc_text(protocol), protocol)


def match(text: str, protocol: Protocol) -> Database:
    """Pair a DBC text with the generated classes; raises `DatabaseError` where they differ."""
    dbc = cantools.database.load_string(text, "dbc")
    if not isinstance(dbc, CantoolsDatabase):
        raise DatabaseError("the packaged file is no CAN database")
    attributes = dbc.dbc.attributes if dbc.dbc else {}
    digest = attributes["SpecDigest"].value if "SpecDigest" in attributes else "none"
    if digest != protocol.digest:
        raise DatabaseError(
            f"{_dbc_name(protocol)} has spec digest {digest}, the generated code {protocol.digest}:"
            " run `dbcspec generate`, or install swapcan again"
        )
    entries = [_entry(message, dbc, protocol) for message in protocol.messages]
    return Database(
        by_type={entry.type: entry for entry in entries},
        by_frame_id={entry.type.FRAME_ID: entry for entry in entries},
    )


def _dbc_name(protocol: Protocol) -> str:
    return f"{protocol.name}.dbc"


def _entry(message: type[Message], dbc: CantoolsDatabase, protocol: Protocol) -> Entry:
    in_dbc = dbc.get_message_by_name(message.NAME)
    ours = [field.dbc_name for field in message.FIELDS.values()]
    # Decoders take raw values by position, in the order in which cantools lists signals.
    if ours != [signal.name for signal in in_dbc.signals]:
        raise DatabaseError(
            f"{message.NAME} has other signals, or in another order, in {_dbc_name(protocol)}"
        )
    counter = Packer(in_dbc, only=[message.COUNTER.dbc_name]) if message.COUNTER else None
    return Entry(message, Packer(in_dbc), protocol.decoders[message], counter)
