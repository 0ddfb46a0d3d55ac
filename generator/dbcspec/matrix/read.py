"""An Excel CAN matrix to the model: ours, and those of others with Chinese or English headings."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from dbcspec.errors import Fault, SpecError
from dbcspec.matrix import headings as known
from dbcspec.matrix.acting import ACTING_COLUMNS
from dbcspec.matrix.grid import CellValue, Grid, read_grids
from dbcspec.matrix.messages import read_messages
from dbcspec.matrix.row import Row, Sheet, open_sheet
from dbcspec.matrix.signal import SharedTables
from dbcspec.matrix.values import names_of, raw_of, text_of, whole_of
from typedcan.model.errors import ReadError
from typedcan.model.protocol import Aspect, Bus, Erratum, Message, Node, Protocol

_LARGEST_ADDRESS = 255
_MOST_BIT_RATE = 100_000_000
_LAST_COVER_ROW = 40
_FEWEST_FACTS = 3


def read_matrix(path: Path, *, shown_as: str | None = None) -> Protocol:
    """Read the first sheet that looks like a matrix, and what the sheets around it say.

    ``shown_as`` is what errors and locations call the file. Locations are ``file.xlsx!Sheet``
    with row and column as line and column. Headings may be Chinese, English or both, in any
    order; other columns and sheets are ignored. Start bits of "Motorola" signals are those of the
    most significant bit unless "Motorola LSB" stands there. Raises `ReadError` for a file that is
    no readable workbook or has no matrix, and `SpecError` with every faulty cell.
    """
    name = shown_as or str(path)
    grids = read_grids(path, name)
    faults: list[Fault] = []
    nodes = _nodes(grids, faults)
    sheet = open_sheet(_matrix_table(grids, name), nodes or {})
    tables = SharedTables()
    messages = read_messages(sheet, tables)
    faults += sheet.faults
    if not messages and not faults:
        raise ReadError(f"{name}: sheet {sheet.grid.name} has no message below its headings")
    buses = tuple(_buses(grids, faults))
    errata = tuple(_errata(grids, faults))
    if faults:
        raise SpecError(faults)
    cover = _cover(grids)
    return Protocol(
        name=cover.get("name") or path.stem,
        number=cover.get("number", ""),
        title=cover.get("title", ""),
        english=cover.get("english", ""),
        edition=cover.get("edition", ""),
        nodes=tuple((nodes or {name: Node(name=name) for name in sheet.nodes}).values()),
        buses=buses,
        messages=tuple(messages),
        value_tables=tables.all(),
        errata=errata,
        carries=frozenset(_carries(sheet, grids, messages)),
    )


def _matrix_table(grids: list[Grid], name: str) -> known.Table:
    """The one sheet with the headings of a matrix."""
    tables = [known.find_table(grid, known.MATRIX) for grid in grids]
    best = max(tables, key=lambda table: len(table.columns), default=None)
    if best is None:
        raise ReadError(f"{name}: has no sheet with cells")
    found = [table for table in tables if not set(known.MATRIX_NEEDS) - set(table.columns)]
    if len(found) > 1:
        sheets = ", ".join(table.grid.name for table in found)
        raise ReadError(f"{name}: more than one sheet is a matrix: {sheets}; keep one")
    if found:
        return found[0]
    missing = [key for key in known.MATRIX_NEEDS if key not in best.columns]
    heading = known.MATRIX[missing[0]].split()[0]
    words = f"{heading} ({missing[0].replace('msg', 'message').replace('_', ' ')})"
    where = f"sheet {best.grid.name} comes closest, but has" if best.columns else "no sheet has"
    raise ReadError(f"{name}: no CAN matrix: {where} no column {words}")


def _carries(sheet: Sheet, grids: list[Grid], messages: Iterable[Message]) -> Iterator[Aspect]:
    """What the columns can say at all."""
    for aspect, keys in (
        (Aspect.PERIODS, ("period",)),
        (Aspect.START_VALUES, ("initial",)),
        (Aspect.COMMENTS, ("title",)),
        (Aspect.REFERENCES, ("reference", "errata")),
        (Aspect.VALUE_TABLE_NAMES, ("value_table",)),
        (Aspect.PROTECTION, ("protection",)),
        (Aspect.ACTS, ACTING_COLUMNS),
    ):
        if all(map(sheet.has, keys)):
            yield aspect
    if any(message.is_fd or message.by_pgn for message in messages):
        yield Aspect.FRAME_FORMATS
    nodes = _side_table(grids, known.NODES, known.NODES_NEED)
    if nodes and "address" in nodes.table.columns:
        yield Aspect.ADDRESSES


def _side_table(
    grids: list[Grid], headings: known.Headings, needs: tuple[str, ...]
) -> Sheet | None:
    """The first table with these headings, anywhere."""
    for grid in grids:
        for row in range(len(grid.rows)):
            if not any(cell.kind == "s" for cell in grid.rows[row]):
                continue
            table = known.find_table(grid, headings, row, row + 1)
            if not set(needs) - set(table.columns):
                texts = {key: grid.cell(row, column).text for key, column in table.columns.items()}
                return Sheet(table, texts, {}, list(table.faults))
    return None


def _side_rows(sheet: Sheet | None, faults: list[Fault]) -> Iterator[Row]:
    """The rows of a side table, up to the first that is empty."""
    if sheet is None:
        return
    last = sheet.table.row
    for row in sheet.rows():
        if row.index != last + 1:
            break
        last = row.index
        yield row
    faults += sheet.faults


def _nodes(grids: list[Grid], faults: list[Fault]) -> dict[str, Node]:
    nodes: dict[str, Node] = {}
    for row in _side_rows(_side_table(grids, known.NODES, known.NODES_NEED), faults):
        name = row.name("name")
        if name in nodes:
            row.fault("name", f"node {name} stands here twice")
        nodes[name] = Node(
            name=name,
            title=row.text("title"),
            english=row.text("english"),
            address=row.read("address", _address, None),
            other_addresses=row.read("other_addresses", _addresses, ()),
            errata=names_of(row.text("errata")),
        )
    return nodes


def _address(cell: CellValue) -> int | None:
    address = raw_of(cell, length=8, signed=False, hexadecimal=False)
    if address is None:
        return None
    return whole_of(CellValue(cell.where, "n", address), 0, _LARGEST_ADDRESS)


def _addresses(cell: CellValue) -> tuple[int, ...]:
    parts = [CellValue(cell.where, "s", text) for text in names_of(text_of(cell))]
    return tuple(address for part in parts if (address := _address(part)) is not None)


def _buses(grids: list[Grid], faults: list[Fault]) -> Iterator[Bus]:
    for row in _side_rows(_side_table(grids, known.BUSES, known.BUSES_NEED), faults):
        rate = row.read("bit_rate", lambda cell: whole_of(cell, 0, _MOST_BIT_RATE), None)
        yield Bus(
            name=row.name("name"),
            title=row.text("title"),
            english=row.text("english"),
            bit_rate=rate or 0,
            nodes=names_of(row.text("nodes")),
            errata=names_of(row.text("errata")),
        )


def _errata(grids: list[Grid], faults: list[Fault]) -> Iterator[Erratum]:
    for row in _side_rows(_side_table(grids, known.ERRATA, known.ERRATA_NEED), faults):
        yield Erratum(
            id=row.name("id"),
            kind=row.text("kind"),
            place=row.text("place"),
            printed=row.text("printed"),
            reading=row.text("reading"),
            because=row.text("because"),
        )


def _cover(grids: list[Grid]) -> dict[str, str]:
    """The facts of the first sheet that has labels on the left and values beside them."""
    for grid in grids:
        facts: dict[str, str] = {}
        for row in range(min(len(grid.rows), _LAST_COVER_ROW)):
            found = known.meanings(grid.cell(row, 0).text, known.COVER)
            if len(found) == 1:
                facts.setdefault(found.pop(), grid.cell(row, 1).text)
        if len(facts) >= _FEWEST_FACTS:
            return facts
    return {}
