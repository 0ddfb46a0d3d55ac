"""What is made of decoded blocks: a table per message, or whatever else derives from them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Protocol as Interface

import pyarrow as pa

from typedcan.logs.arrow import MessageTable
from typedcan.logs.columns import DecodedBlock
from typedcan.model.transfers.kind import ProblemKind

Batch = tuple[str, pa.RecordBatch]
"""Some rows of the table of that name."""


class Shape(Interface):
    """Makes rows of tables from the decoded blocks of one log, in their order.

    What a block's columns hold is overwritten by the next block: a shape copies what it keeps.
    """

    @property
    def schemas(self) -> Mapping[str, pa.Schema]:
        """The tables that it can make, by name."""
        ...

    def take(self, decoded: DecodedBlock) -> Iterator[Batch]:
        """The rows that are complete with this block."""
        ...

    def finish(self) -> Iterator[Batch]:
        """The rows that are left at the end of the log."""
        ...

    @property
    def problems(self) -> Mapping[str, Counter[ProblemKind]]:
        """What was wrong with transfers, by their names, and how often; after the end."""
        return {}

    @property
    def recognised(self) -> Mapping[str, Counter[str]]:
        """By table, how many rows came in which reading of the spec; after the end."""
        return {}

    @property
    def taken_together(self) -> Mapping[str, frozenset[int]]:
        """The source addresses of messages whose rows do not say from which they are."""
        return {}


class PerMessage(Shape):
    """A table per message, with a column per signal."""

    def __init__(self, tables: Mapping[str, MessageTable]) -> None:
        self._tables = tables

    @property
    def schemas(self) -> Mapping[str, pa.Schema]:
        """By name of the message."""
        return {name: table.schema for name, table in self._tables.items()}

    def take(self, decoded: DecodedBlock) -> Iterator[Batch]:
        """The frames of the block."""
        for name, columns in decoded.messages.items():
            yield name, self._tables[name].batch(columns)

    def finish(self) -> Iterator[Batch]:
        """Nothing is left."""
        yield from ()
