"""The packaged DBC, read once by cantools and matched with the generated classes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources

import cantools
from cantools.database.can import Database as CantoolsDatabase

from swapcan import _generated
from swapcan._generated.decoders import DECODERS, Decoder
from swapcan._generated.messages import MESSAGES
from swapcan.errors import DatabaseError, UnknownMessageError
from swapcan.message import Message
from swapcan.packing import Packer

DBC_NAME = f"{_generated.NAME}.dbc"


@dataclass(frozen=True, slots=True)
class Entry:
    """A message class with what packs its bits and what makes it from raw values."""

    type: type[Message]
    packer: Packer
    decode: Decoder


@dataclass(frozen=True, slots=True)
class Database:
    """All messages, by class and by 29-bit identifier."""

    by_type: Mapping[type[Message], Entry]
    by_frame_id: Mapping[int, Entry]


def dbc_text() -> str:
    """The text of the DBC that this package was built with."""
    return resources.files(_generated).joinpath(DBC_NAME).read_text("ascii")


def message_type(name: str) -> type[Message]:
    """The message class of that name; raises `UnknownMessageError`."""
    for message in MESSAGES:
        if name == message.NAME:
            return message
    known = ", ".join(message.NAME for message in MESSAGES)
    raise UnknownMessageError(f"there is no message {name!r}; known: {known}")


@cache
def database() -> Database:
    """Read the packaged DBC; raises `DatabaseError` where it does not fit the generated code."""
    return match(dbc_text())


def match(text: str) -> Database:
    """Pair a DBC text with the generated classes; raises `DatabaseError` where they differ."""
    dbc = cantools.database.load_string(text, "dbc")
    if not isinstance(dbc, CantoolsDatabase):
        raise DatabaseError("the packaged file is no CAN database")
    attributes = dbc.dbc.attributes if dbc.dbc else {}
    digest = attributes["SpecDigest"].value if "SpecDigest" in attributes else "none"
    if digest != _generated.DIGEST:
        raise DatabaseError(
            f"{DBC_NAME} has spec digest {digest}, the generated code {_generated.DIGEST}:"
            " run `dbcspec generate`, or install swapcan again"
        )
    entries = [_entry(message, dbc) for message in MESSAGES]
    return Database(
        by_type={entry.type: entry for entry in entries},
        by_frame_id={entry.type.FRAME_ID: entry for entry in entries},
    )


def _entry(message: type[Message], dbc: CantoolsDatabase) -> Entry:
    in_dbc = dbc.get_message_by_name(message.NAME)
    ours = [field.dbc_name for field in message.FIELDS.values()]
    # Decoders take raw values by position, in the order in which cantools lists signals.
    if ours != [signal.name for signal in in_dbc.signals]:
        raise DatabaseError(f"{message.NAME} has other signals, or in another order, in {DBC_NAME}")
    return Entry(message, Packer(in_dbc), DECODERS[message])
