"""What the spec says of the whole standard, in the model's words: nodes, errata, references."""

from __future__ import annotations

from collections.abc import Iterable

from dbcspec.spec.rows import ErratumRow, SignalRow, SignalTable, Standard
from typedcan.model import protocol as model


def nodes_of(standard: Standard) -> tuple[model.Node, ...]:
    """The nodes."""
    return tuple(
        model.Node(
            name=node.name,
            title=node.title,
            english=node.english,
            address=node.address,
            other_addresses=node.other_addresses,
            errata=node.marks,
        )
        for node in standard.nodes
    )


def errata_of(rows: Iterable[ErratumRow]) -> tuple[model.Erratum, ...]:
    """The errata, for people."""
    return tuple(
        model.Erratum(
            id=row.id,
            kind=row.kind,
            place=row.place,
            printed=row.printed,
            reading=row.reading,
            because=row.because,
        )
        for row in rows
    )


def joined(title: str, part: str) -> str:
    """A title with that of the part, where there is one."""
    return f"{title}: {part}" if part else title


def row_reference(table: SignalTable, row: SignalRow) -> str:
    """Where a row stands."""
    return f"Table {table.number} row {row.no} ({table.clause})"


def table_reference(table: SignalTable) -> str:
    """Where a table stands."""
    return f"Table {table.number} ({table.clause})"
