"""Tables in memory, for pandas, polars and whatever else takes Arrow."""

from __future__ import annotations

import pyarrow as pa


class Memory:
    """Keeps all rows."""

    def __init__(self) -> None:
        self._parts: dict[str, list[pa.Table]] = {}

    def begin(self, timestamp: float) -> None:
        """Time stamps are kept as they are."""

    def write(self, name: str, rows: pa.Table) -> None:
        """Add rows to the table of that name."""
        self._parts.setdefault(name, []).append(rows)

    def close(self) -> None:
        """Nothing is left to be done."""

    def abort(self) -> None:
        """Nothing is to be undone."""

    def tables(self) -> dict[str, pa.Table]:
        """What was written, with one dictionary per column."""
        return {
            name: pa.concat_tables(parts).unify_dictionaries()
            for name, parts in self._parts.items()
        }
