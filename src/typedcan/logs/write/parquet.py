"""Parquet files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq


class ParquetFile:
    """A Parquet file that grows by a row group at a time.

    Parameters
    ----------
    path
        The file; one that is there is overwritten.
    schema
        Of the table.
    """

    def __init__(self, path: Path, schema: pa.Schema) -> None:
        # Times rarely repeat: a dictionary of them would be built for nothing. Their bytes, split
        # into streams, compress to a third.
        times: Any = [name for name in schema.names if name == "timestamp"]
        others: Any = [name for name in schema.names if name != "timestamp"]
        self._writer = pq.ParquetWriter(
            path,
            schema,
            compression="zstd",
            compression_level=1,
            use_dictionary=others,
            column_encoding={"timestamp": "BYTE_STREAM_SPLIT"},
            # Times are what readers skip row groups by. Those of all columns take half the time.
            write_statistics=times,
        )

    def write(self, rows: pa.Table) -> None:
        """Add a row group."""
        self._writer.write_table(rows, row_group_size=len(rows))

    def close(self) -> None:
        """Write the footer."""
        self._writer.close()
