"""CSV files: comma-separated, UTF-8, a header of column names, nothing where there is no value."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pyarrow as pa
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
        self._writer = csv.CSVWriter(
            str(path), self._schema, write_options=csv.WriteOptions(quoting_style="needed")
        )

    def write(self, rows: pa.Table) -> None:
        """Add rows."""
        for place, part in enumerate(rows.schema):
            if not is_plain(part.type):
                rows = rows.set_column(place, part.name, text_array(rows.column(place)))
        self._writer.write_table(rows.cast(self._schema))

    def close(self) -> None:
        """Finish the file."""
        self._writer.close()


def _plain(part: pa.Field[Any]) -> pa.Field[Any]:
    """The column with words in place of a dictionary, and texts in place of bytes and lists."""
    if not is_plain(part.type):
        return pa.field(part.name, pa.string())
    kind = part.type.value_type if pa.types.is_dictionary(part.type) else part.type
    return pa.field(part.name, kind)
