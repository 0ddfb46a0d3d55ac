"""Where rows of tables go, and what puts them together to pieces of a good size."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Protocol

import pyarrow as pa

_ROWS = 1 << 16
"""Rows that a table is written with at a time, at least, as long as memory allows."""

_BYTES = 96 << 20
"""What all tables together may hold back."""


class Sink(Protocol):
    """Takes the rows of tables, each in their order."""

    def begin(self, timestamp: float) -> None:
        """Learn the time stamp of the first frame; once, before the first rows."""
        ...

    def write(self, name: str, rows: pa.Table) -> None:
        """Add rows to the table of that name."""
        ...

    def close(self) -> None:
        """Finish all tables; nothing is written after it."""
        ...

    def abort(self) -> None:
        """Close what is open, finished or not."""
        ...


class TableFile(Protocol):
    """The file of one table."""

    def write(self, rows: pa.Table) -> None:
        """Add rows."""
        ...

    def close(self) -> None:
        """Finish the file."""
        ...


OpenTable = Callable[[Path, pa.Schema], TableFile]


class Files:
    """A file per table, opened with its first rows.

    Parameters
    ----------
    open_table
        What opens a file.
    place
        The file of a table, by its name.
    """

    def __init__(self, open_table: OpenTable, place: Callable[[str], Path]) -> None:
        self._open_table = open_table
        self._place = place
        self._files: dict[str, TableFile] = {}

    def begin(self, timestamp: float) -> None:
        """Time stamps are kept as they are."""

    def open(self, name: str, schema: pa.Schema) -> TableFile:
        """The file of a table, also of one that gets no rows."""
        if name not in self._files:
            self._files[name] = self._open_table(self._place(name), schema)
        return self._files[name]

    def write(self, name: str, rows: pa.Table) -> None:
        """Add rows to the table of that name."""
        self.open(name, rows.schema).write(rows)

    def close(self) -> None:
        """Finish all files."""
        while self._files:
            self._files.popitem()[1].close()

    def abort(self) -> None:
        """Close what is open."""
        self.close()


class Gathering:
    """Gathers small batches until there are enough rows to be written together.

    Parameters
    ----------
    sink
        What they are written to.
    rows
        Rows that are written together.
    """

    def __init__(self, sink: Sink, rows: int = _ROWS) -> None:
        self._sink = sink
        self._enough = rows
        self._held: dict[str, list[pa.RecordBatch]] = {}
        self._rows: dict[str, int] = {}
        self._bytes: dict[str, int] = {}

    def begin(self, timestamp: float) -> None:
        """The time stamp of the first frame."""
        self._sink.begin(timestamp)

    def add(self, name: str, batch: pa.RecordBatch) -> None:
        """Add a batch to the table of that name."""
        self._held.setdefault(name, []).append(batch)
        self._rows[name] = self._rows.get(name, 0) + batch.num_rows
        self._bytes[name] = self._bytes.get(name, 0) + batch.nbytes
        if self._rows[name] >= self._enough:
            self._write(name)
        while sum(self._bytes.values()) > _BYTES:
            self._write(max(self._bytes, key=lambda key: self._bytes[key]))

    def flush(self) -> None:
        """Write what is held back."""
        for name in list(self._held):
            self._write(name)

    def _write(self, name: str) -> None:
        del self._rows[name], self._bytes[name]
        self._sink.write(name, pa.Table.from_batches(self._held.pop(name)))
