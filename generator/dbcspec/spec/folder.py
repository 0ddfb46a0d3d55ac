"""A spec folder on disk to rows as printed."""

from __future__ import annotations

import dataclasses
from pathlib import Path

from dbcspec.errors import Fault, SpecError
from dbcspec.spec.behaviour_rows import Behaviour
from dbcspec.spec.database_rows import Database
from dbcspec.spec.errata_rows import Errata
from dbcspec.spec.rows import (
    Edition,
    EditionHead,
    EditionMessages,
    Messages,
    SameCodes,
    SignalRow,
    SignalTable,
    Spec,
)
from dbcspec.spec.schema import RecordT
from dbcspec.spec.source import read_yaml
from dbcspec.spec.standard_rows import Standard
from typedcan.model.errors import Location

_EDITION = "edition.yaml"
_EDITIONS = f"editions/*/{_EDITION}"
"""Where a spec folder has the heads of its editions."""


def read_spec(folder: Path, shown_as: str) -> Spec:
    """Read a spec folder as printed; raises `SpecError` with the faults of all its files.

    ``shown_as`` is the folder's path as locations shall name it. behaviour.yaml, errata.yaml,
    database.yaml and editions may be absent, the rest must be there.
    """
    reader = _FolderReader(folder, shown_as)
    standard = reader.read(Standard, "standard.yaml")
    messages = reader.read(Messages, "messages.yaml")
    behaviour = reader.read_if_there(Behaviour, "behaviour.yaml")
    errata = reader.read_if_there(Errata, "errata.yaml")
    database = reader.read_if_there(Database, "database.yaml")
    tables = reader.tables()
    editions = [_edition(reader, path.parent) for path in sorted(folder.glob(_EDITIONS))]
    if reader.faults or standard is None or messages is None:
        raise SpecError(reader.faults)
    return Spec(
        standard=standard,
        messages=messages,
        tables=tuple(tables),
        behaviour=behaviour or Behaviour(where=Location(f"{shown_as}/behaviour.yaml")),
        errata=errata.errata if errata else (),
        database=database,
        editions=tuple(filter(None, editions)),
    )


def _edition(reader: _FolderReader, folder: Path) -> Edition | None:
    """The edition in a folder below the spec's; what is wrong in it is the reader's to tell."""
    inner = _FolderReader(folder, f"{reader.shown_as}/editions/{folder.name}")
    inner.faults = reader.faults
    head = inner.read(EditionHead, _EDITION)
    errata = inner.read_if_there(Errata, "errata.yaml")
    messages = inner.read_if_there(EditionMessages, "messages.yaml")
    tables = inner.tables()
    if head is None:
        return None
    rows = messages.messages if messages else ()
    return Edition(
        name=folder.name,
        head=head,
        errata=errata.errata if errata else (),
        messages=tuple(dataclasses.replace(row, annex=folder.name) for row in rows),
        tables=tables,
    )


class _FolderReader:
    """Reads the files of one folder and collects what is wrong in any of them."""

    def __init__(self, folder: Path, shown_as: str) -> None:
        self._folder = folder
        self.shown_as = shown_as
        self.faults: list[Fault] = []

    def tables(self) -> tuple[SignalTable, ...]:
        """The signal tables of the folder, by the order of their file names."""
        tables = [
            dataclasses.replace(table, stem=path.stem)
            for path in sorted((self._folder / "tables").glob("*.yaml"))
            if (table := self.read(SignalTable, f"tables/{path.name}")) is not None
        ]
        return tuple(_without_references(table, self.faults) for table in tables)

    def read(self, record: type[RecordT], name: str) -> RecordT | None:
        try:
            return record.read(read_yaml(self._folder / name, f"{self.shown_as}/{name}"))
        except SpecError as error:
            self.faults.extend(error.faults)
            return None

    def read_if_there(self, record: type[RecordT], name: str) -> RecordT | None:
        return self.read(record, name) if (self._folder / name).exists() else None


def _without_references(table: SignalTable, faults: list[Fault]) -> SignalTable:
    """Replace each same_as by the codes of the row it names."""
    printed = {row.name: row for row in table.rows if not isinstance(row.codes, SameCodes)}
    rows: list[SignalRow] = []
    for row in table.rows:
        if not isinstance(row.codes, SameCodes):
            rows.append(row)
        elif same := printed.get(row.codes.row):
            rows.append(
                dataclasses.replace(row, codes=same.labels, english_codes=same.english_codes)
            )
        else:
            text = f"same_as: no row {row.codes.row!r} with codes in this table"
            faults.append(Fault(row.where_is("codes"), text))
    return dataclasses.replace(table, rows=tuple(rows))
