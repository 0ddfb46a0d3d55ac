"""DBC files, and the other formats that cantools reads, to the model."""

from __future__ import annotations

import dataclasses
import gc
import logging
from collections.abc import Iterator, Set
from contextlib import contextmanager
from pathlib import Path

import cantools.database
import textparser
from cantools.database.can import Database
from cantools.database.errors import UnsupportedDatabaseFormatError

from typedcan.databases.database import Labels, Places, to_protocol
from typedcan.databases.dbc_text import UNASSIGNED, DbcText
from typedcan.databases.encoding import LARGEST_FILE, read_text
from typedcan.databases.sizes import refuse_large
from typedcan.model.errors import Location, ReadError
from typedcan.model.protocol import Protocol

FORMATS = {".dbc": "dbc", ".kcd": "kcd", ".sym": "sym", ".arxml": "arxml"}
"""Ends of file names, in small letters, and what cantools calls the format."""

_LONGEST_EXCERPT = 60

# The linter says what is odd in a file; cantools would say it again on standard error.
logging.getLogger("cantools").addHandler(logging.NullHandler())


def read_dbc(
    path: Path,
    encoding: str | None = None,
    *,
    shown_as: str | None = None,
    largest: int = LARGEST_FILE,
    labels: Labels | None = None,
    wide: bool = False,
) -> Protocol:
    """Read a DBC file, sound or not: overlaps and signals outside their message are kept.

    Without ``encoding`` it is found out, see `typedcan.databases.encoding`. ``shown_as`` is what
    errors and locations call the file, ``largest`` the bytes it may have, ``labels`` which labels
    mean that a code is no value. With ``wide`` an identifier of more than 11 bits, whose line does
    not say that it has 29, is kept as one of 11, for the linter to find. A range of [0|0] counts as
    not given. Of several senders the first is kept. Raises `ReadError`.
    """
    name = shown_as or str(path)
    with _collection_paused():
        text = read_text(path, encoding, shown_as=name, largest=largest)
        return _read_dbc(DbcText(text, name, wide=wide), name, labels or Labels())


def _read_dbc(source: DbcText, name: str, labels: Labels) -> Protocol:
    database = _load(f"{source.mended()}\n{_END}", "dbc", name)
    places = [
        Places(
            Location(name, place.line),
            [Location(name, line) for _, line in place.signals],
            [short for short, _ in place.signals],
        )
        for place in source.places
        if place.name != UNASSIGNED
    ]
    protocol = to_protocol(database, name, places, labels)
    return _narrowed(protocol, source.unmarked) if source.unmarked else protocol


def _narrowed(protocol: Protocol, identifiers: Set[int]) -> Protocol:
    """The protocol with these identifiers as the file has them: with 11 bits."""
    messages = (
        dataclasses.replace(each, extended=False) if each.frame_id in identifiers else each
        for each in protocol.messages
    )
    return dataclasses.replace(protocol, messages=tuple(messages))


@contextmanager
def _collection_paused() -> Iterator[None]:
    """A large file makes millions of objects, nearly all of which stay.

    Looking for garbage among them again and again would cost a third of the time.
    """
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


def read_any(
    path: Path,
    encoding: str | None = None,
    *,
    shown_as: str | None = None,
    largest: int = LARGEST_FILE,
    labels: Labels | None = None,
    wide: bool = False,
) -> Protocol:
    """Read a file of any format in `FORMATS`, by the end of its name; see `read_dbc`.

    Only in DBC files messages and signals have their lines. Raises `ReadError`.
    """
    name = shown_as or str(path)
    format_ = FORMATS.get(path.suffix.lower())
    if format_ is None:
        known = ", ".join(FORMATS)
        raise ReadError(f"{name}: cannot read {path.suffix or 'this'} files; known: {known}")
    if format_ == "dbc":
        return read_dbc(path, encoding, shown_as=name, largest=largest, labels=labels, wide=wide)
    text = read_text(path, encoding, shown_as=name, largest=largest)
    refuse_large(text, format_, name)
    database = _load(text, format_, name)
    places = [
        Places(Location(name), [Location(name)] * len(message.signals))
        for message in database.messages
    ]
    return to_protocol(database, name, places, labels or Labels())


def read_database(path: Path) -> Protocol:
    """Read a file of any format: a name that ends in none of `FORMATS` is that of a DBC file."""
    return (read_any if path.suffix.lower() in FORMATS else read_dbc)(path)


_END = "BS_:\n"
"""A statement that means nothing: before the end of a file cantools forgives half a statement."""


def _load(text: str, format_: str, name: str) -> Database:
    try:
        # Unsorted, as they stand: places and the order of the model depend on it.
        database = cantools.database.load_string(text, format_, strict=False, sort_signals=None)
    except UnsupportedDatabaseFormatError as error:
        reason = error.e_dbc or error.e_kcd or error.e_sym or error.e_arxml
        raise ReadError(_reason(reason, text, format_, name)) from None
    if not isinstance(database, Database):
        raise ReadError(f"{name}: describes diagnostics, not CAN messages")
    return database


def _reason(reason: Exception | None, text: str, format_: str, name: str) -> str:
    """Why cantools cannot read a text, as one line with its place."""
    if not isinstance(reason, textparser.ParseError):
        return f"{name}: not read as {format_.upper()}: {' '.join(str(reason).split())}"
    if text.endswith(_END) and reason.line > text.count("\n") - 1:
        return f"{name}: the last statement is cut off"
    excerpt = " ".join(text.split("\n")[reason.line - 1].split())[:_LONGEST_EXCERPT]
    return f"{Location(name, reason.line, reason.column)}: not understood: {excerpt}"
