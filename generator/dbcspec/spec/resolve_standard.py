"""What the spec says of the whole standard, in the model's words: nodes, errata, references."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from dbcspec.spec.readings import ReadErratum
from dbcspec.spec.rows import SignalRow, SignalTable
from dbcspec.spec.standard_rows import Standard
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


def errata_of(errata: Iterable[ReadErratum]) -> tuple[model.Erratum, ...]:
    """The errata, for people."""
    return tuple(
        model.Erratum(
            id=each.id,
            kind=each.row.kind,
            place=each.row.place,
            printed=each.row.printed,
            reading=each.reading,
            because=each.because,
            source=each.source,
            alternatives=tuple(_others(each)),
        )
        for each in errata
    )


def _others(erratum: ReadErratum) -> Iterator[model.Alternative]:
    """The readings of its place that are not in force."""
    row = erratum.row
    readings = [(row.id, row.reading, row.because, row.source)]
    readings += [(each.id, each.reading, each.because, each.source) for each in row.alternatives]
    for number, reading, because, source in readings:
        if number != erratum.id:
            yield model.Alternative(id=number, reading=reading, because=because, source=source)


def joined(title: str, part: str) -> str:
    """A title with that of the part, where there is one."""
    return f"{title}: {part}" if part else title


def row_reference(table: SignalTable, row: SignalRow) -> str:
    """Where a row stands."""
    return f"Table {table.number} row {row.no} ({table.clause})"


def table_reference(table: SignalTable) -> str:
    """Where a table stands."""
    return f"Table {table.number} ({table.clause})"
