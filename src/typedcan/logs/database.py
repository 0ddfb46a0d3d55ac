"""The protocol of a database file, for whoever has no package of it."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from typedcan.databases.dbc import FORMATS, read_any, read_dbc
from typedcan.logs.protocol import Protocol, read, same
from typedcan.model.errors import ReadError, TypedcanError
from typedcan.shell.printing import printable


class DbcError(TypedcanError):
    """A database cannot be read."""


@cache
def protocol_of(database: Path | None, own: Protocol) -> Protocol:
    """The protocol of a database file, ``own`` where none is given.

    A file made from ``own`` says the same in other words, such as Chinese labels: what else is
    known of it counts too. A name that ends in no known format is that of a DBC file.

    Raises
    ------
    DbcError
        Where there is no such file, or it cannot be read.
    """
    if database is None:
        return own
    reader = read_any if database.suffix.lower() in FORMATS else read_dbc
    try:
        model = reader(database)
    except ReadError as error:
        raise DbcError(printable(str(error))) from None
    found = read(model, printable(database.stem))  # a file's name may hold bytes that are no text
    return same(found, own) if found.digest and found.digest == own.digest else found
