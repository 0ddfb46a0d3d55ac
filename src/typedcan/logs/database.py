"""The protocol of a database file, for whoever has no package of it."""

from __future__ import annotations

import logging
from functools import cache
from pathlib import Path

from typedcan.databases.dbc import read_database
from typedcan.logs.protocol import Protocol, read, same
from typedcan.model.errors import ReadError, TypedcanError
from typedcan.model.soundness import remark
from typedcan.shell.printing import printable

_LOG = logging.getLogger(__name__)


class DbcError(TypedcanError):
    """A database cannot be read."""


@cache
def protocol_of(database: Path | None, own: Protocol | None) -> Protocol:
    """The protocol of a database file, ``own`` where none is given.

    A file made from ``own`` says the same in other words, such as Chinese labels: what else is
    known of it counts too. One of both has to be given.

    Raises
    ------
    DbcError
        Where there is no such file, or it cannot be read.
    """
    if database is None:
        if own is None:
            raise DbcError("a protocol, or a database of one, is needed")
        return own
    try:
        model = read_database(database)
    except ReadError as error:
        raise DbcError(printable(str(error))) from None
    if odd := remark(model):
        _LOG.warning(odd)
    found = read(model, printable(database.stem))  # a file's name may hold bytes that are no text
    return same(found, own) if own and found.digest and found.digest == own.digest else found
