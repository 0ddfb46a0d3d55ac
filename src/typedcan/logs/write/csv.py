"""CSV files: comma-separated, UTF-8, a header of column names, nothing where there is no value."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.compute as pc
from pyarrow import csv

from typedcan.logs.write.plain import is_plain, text_array


class CsvFile:
    """A CSV file that grows by some rows at a time.

    Parameters
    ----------
    path
        The file; one that is there is overwritten.
    schema
        Of the table. Its metadata have no place in CSV.
    """

    def __init__(self, path: Path, schema: pa.Schema) -> None:
        self._schema = pa.schema([_plain(part) for part in schema])
        self._names = [_guarded(part.name) for part in schema]
        self._writer = csv.CSVWriter(
            str(path),
            self._named(self._schema),
            write_options=csv.WriteOptions(quoting_style="needed"),
        )

    def write(self, rows: pa.Table) -> None:
        """Add rows."""
        for place, part in enumerate(rows.schema):
            if not is_plain(part.type):
                rows = rows.set_column(place, part.name, text_array(rows.column(place)))
            elif pa.types.is_dictionary(part.type) or pa.types.is_string(part.type):
                rows = rows.set_column(place, part.name, guarded(rows.column(place)))
        rows = rows.cast(self._schema)
        self._writer.write_table(rows.rename_columns(self._names))

    def _named(self, schema: pa.Schema) -> pa.Schema:
        names = zip(schema, self._names, strict=True)
        return pa.schema([part.with_name(name) for part, name in names])

    def close(self) -> None:
        """Finish the file."""
        self._writer.close()


_FORMULA = r"^([=+\-@\t\r])"
"""How a text begins that a spreadsheet takes for a formula."""


def _guarded(text: str) -> str:
    return re.sub(_FORMULA, r"'\1", text)


def guarded(column: pa.ChunkedArray[Any]) -> pa.ChunkedArray[Any]:
    """Texts, those with an apostrophe before them that a spreadsheet would calculate.

    Names and labels come from databases that anybody may have written.
    """
    words: Any = column
    if pa.types.is_dictionary(column.type):
        words = pc.cast(column, column.type.value_type)
    found: pa.ChunkedArray[Any] = pc.replace_substring_regex(words, _FORMULA, r"'\1")
    return found


def _plain(part: pa.Field[Any]) -> pa.Field[Any]:
    """The column with words in place of a dictionary, and texts in place of bytes and lists."""
    if not is_plain(part.type):
        return pa.field(part.name, pa.string())
    kind = part.type.value_type if pa.types.is_dictionary(part.type) else part.type
    return pa.field(part.name, kind)
