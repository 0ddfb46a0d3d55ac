"""Arrow IPC files (Feather version 2)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pyarrow as pa


class ArrowFile:
    """An Arrow IPC file that grows by some rows at a time.

    Parameters
    ----------
    path
        The file; one that is there is overwritten.
    schema
        Of the table.
    """

    def __init__(self, path: Path, schema: pa.Schema) -> None:
        options = pa.ipc.IpcWriteOptions(compression="lz4", emit_dictionary_deltas=True)
        self._writer = pa.ipc.new_file(str(path), schema, options=options)
        self._words: dict[str, dict[str | None, int]] = {}

    def write(self, rows: pa.Table) -> None:
        """Add rows."""
        whole = rows.unify_dictionaries().combine_chunks()
        columns: list[Any] = [
            self._extended(part.name, column.combine_chunks())
            if pa.types.is_dictionary(part.type)
            else column
            for part, column in zip(whole.schema, whole.columns, strict=True)
        ]
        self._writer.write_table(pa.Table.from_arrays(columns, schema=rows.schema))

    def close(self) -> None:
        """Write the footer."""
        self._writer.close()

    def _extended(self, name: str, column: Any) -> pa.Array[Any]:
        """The column on a dictionary that begins with all words so far: the format wants it so."""
        if isinstance(column, pa.ChunkedArray):
            column = column.chunk(0) if column.num_chunks else pa.array([], column.type)
        words = self._words.setdefault(name, {})
        places = [words.setdefault(word, len(words)) for word in column.dictionary.to_pylist()]
        lookup = pa.array(places, column.indices.type)
        indices = lookup.take(column.indices)
        return pa.DictionaryArray.from_arrays(indices, pa.array(list(words), pa.string()))
