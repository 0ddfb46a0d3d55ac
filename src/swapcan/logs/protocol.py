"""What converting needs to know of a protocol: its messages, periods, reserved codes, citations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import cantools
from cantools.database.can import Database, Message

from swapcan._generated.protocol import PROTOCOL
from swapcan.logs.plan import Reserved
from swapcan.logs.reserved import reserved_codes
from swapcan.wire import dbc_text
from typedcan.model.errors import TypedcanError
from typedcan.shell.printing import printable
from typedcan.wire.errors import one_line
from typedcan.wire.message import Message as OwnMessage


class DbcError(TypedcanError):
    """A DBC file cannot be read."""


@dataclass(frozen=True, slots=True)
class Protocol:
    """The messages that frames are decoded by.

    Parameters
    ----------
    name, digest
        Of the protocol; the digest is empty where the DBC carries none.
    messages
        As cantools has them.
    reserved
        Raw codes that are no value; empty for a DBC of somebody else's.
    references
        Where in the standard a signal stands, by names of message and signal.
    periods
        Seconds between two frames of a message that is sent periodically.
    conditional
        The names of those that are sent only while a condition holds: when they end is no gap.
    checked
        The classes of messages whose length, checksum and alive counter are known, by name.
    """

    name: str
    digest: str
    messages: Sequence[Message]
    reserved: Reserved
    references: Mapping[tuple[str, str], str]
    periods: Mapping[str, float]
    conditional: frozenset[str]
    checked: Mapping[str, type[OwnMessage]]


@cache
def protocol_of(dbc: Path | None = None) -> Protocol:
    """The protocol of a DBC file, this package's own where none is given.

    Raises
    ------
    DbcError
        Where there is no such file, or cantools cannot read it.
    """
    if dbc is None:
        return _own(_load(dbc_text(), "the packaged DBC"))
    try:
        text = dbc.read_text(encoding="cp1252", errors="replace")
    except OSError as error:
        raise DbcError(f"{dbc}: {error.strerror or error}") from None
    database = _load(text, str(dbc))
    digest = _digest(database)
    if digest == PROTOCOL.digest:
        return _own(database)
    name = printable(dbc.stem)  # a file's name may hold bytes that are no text
    return Protocol(name, digest, database.messages, {}, {}, _periods(database), frozenset(), {})


def _load(text: str, where: str) -> Database:
    try:
        # Not strict: signals that overlap are found in many files, and harm nobody else.
        database = cantools.database.load_string(text, "dbc", strict=False)
    except (cantools.Error, ValueError, KeyError, IndexError) as error:
        raise DbcError(f"{where}: cantools cannot read it: {one_line(error)}") from None
    if not isinstance(database, Database):
        raise DbcError(f"{where}: this is no CAN database")
    return database


def _own(database: Database) -> Protocol:
    return Protocol(
        PROTOCOL.name,
        PROTOCOL.digest,
        database.messages,
        reserved_codes(),
        {
            (message.NAME, part.dbc_name): part.reference
            for message in PROTOCOL.messages
            for part in message.FIELDS.values()
        },
        {message.NAME: message.PERIOD for message in PROTOCOL.messages if message.PERIOD},
        frozenset(message.NAME for message in PROTOCOL.conditional),
        {message.NAME: message for message in PROTOCOL.messages},
    )


def _digest(database: Database) -> str:
    attributes = database.dbc.attributes if database.dbc else {}
    return str(attributes["SpecDigest"].value) if "SpecDigest" in attributes else ""


def _periods(database: Database) -> dict[str, float]:
    return {
        message.name: message.cycle_time / 1000
        for message in database.messages
        if message.cycle_time
    }
