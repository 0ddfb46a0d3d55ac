"""One row of the matrix by the names of its columns; faulty cells are collected."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TypeVar

from dbcspec.errors import Fault
from dbcspec.matrix.grid import CellValue, Grid
from dbcspec.matrix.headings import Table, normal
from dbcspec.matrix.values import CellError, text_of
from typedcan.model.errors import Location

T = TypeVar("T")

_ROLES = {
    **dict.fromkeys(("s", "tx", "t", "发", "发送"), "S"),
    "s2": "2",
    "s2/r": "2R",
    **dict.fromkeys(("r", "rx", "收", "接收"), "R"),
    **dict.fromkeys(("s/r", "sr", "r/s", "s,r", "tx/rx", "收发"), "SR"),
}
_NODE = re.compile(r"(?:节点|node)\s*:\s*(\w+)", re.IGNORECASE)


@dataclass(slots=True)
class Sheet:
    """A table with its node columns, and the faults found in it so far."""

    table: Table
    headings: dict[str, str]
    nodes: dict[str, int]
    faults: list[Fault] = field(default_factory=list[Fault])

    @property
    def grid(self) -> Grid:
        """The cells."""
        return self.table.grid

    def has(self, key: str) -> bool:
        """Whether there is such a column."""
        return key in self.table.columns

    def rows(self) -> Iterable[Row]:
        """The rows below the headings, those with nothing in a known column left out."""
        for index in range(self.table.row + 1, len(self.grid.rows)):
            row = Row(self, index)
            if any(not row.cell(key).is_blank for key in self.table.columns):
                yield row


@dataclass(frozen=True, slots=True)
class Row:
    """A row; asking for a column that is not there gives an empty cell."""

    sheet: Sheet
    index: int

    @property
    def where(self) -> Location:
        """The location of its first cell."""
        return self.sheet.grid.where(self.index, 0)

    def cell(self, key: str) -> CellValue:
        """The cell under a heading."""
        return self.sheet.grid.cell(self.index, self.sheet.table.columns.get(key, 1 << 20))

    def fault(self, key: str, text: str) -> None:
        """Record what is wrong with a cell."""
        column = self.sheet.table.columns.get(key, 0)
        self.sheet.faults.append(Fault(self.sheet.grid.where(self.index, column), text))

    def read(self, key: str, function: Callable[[CellValue], T], instead: T) -> T:
        """What the function makes of a cell; ``instead``, and a fault, where it refuses it."""
        try:
            return function(self.cell(key))
        except CellError as error:
            self.fault(key, str(error))
            return instead

    def text(self, key: str) -> str:
        """The text of a cell."""
        return self.read(key, text_of, "")

    def name(self, key: str) -> str:
        """A name: without spaces around it, full-width letters made plain."""
        return normal(self.text(key))

    def is_hex(self, key: str) -> bool:
        """Whether the heading of a column says that its numbers are hexadecimal."""
        return "hex" in self.sheet.headings.get(key, "").lower()

    def roles(self) -> tuple[list[str], list[str]]:
        """The nodes that send and those that receive; those that send besides come last."""
        senders: list[str] = []
        others: list[str] = []
        receivers: list[str] = []
        for node, column in self.sheet.nodes.items():
            cell = self.sheet.grid.cell(self.index, column)
            role = _role(cell)
            if role is None:
                text = f"expected S (sends), R (receives) or nothing, not {cell.text.strip()!r}"
                self.sheet.faults.append(Fault(cell.where, text))
            elif role:
                senders += [node] if "S" in role else []
                others += [node] if "2" in role else []
                receivers += [node] if "R" in role else []
        return senders + others, receivers


def open_sheet(table: Table, declared: Iterable[str]) -> Sheet:
    """The sheet of a matrix; ``declared`` are the nodes that another sheet names.

    A column is a node's where its heading is one of them, or is no other column's and most of
    what stands below it is S or R.
    """
    grid = table.grid
    names = set(declared)
    columns = dict(table.columns)
    nodes: dict[str, int] = {}
    twice: list[Fault] = []
    for column, heading in enumerate(grid.rows[table.row]):
        text = normal(heading.text)
        prefixed = _NODE.fullmatch(text)
        name = prefixed[1] if prefixed else text
        known = column in columns.values()
        if not name or not (
            prefixed or name in names or (not known and _holds_roles(table, column))
        ):
            continue
        if name in nodes:
            twice.append(Fault(heading.where, f"a second column for the node {name}: keep one"))
        nodes.setdefault(name, column)
        columns = {key: index for key, index in columns.items() if index != column}
    faults = [
        fault for fault in table.faults if fault.where.column - 1 not in nodes.values()
    ] + twice
    headings = {key: normal(grid.cell(table.row, index).text) for key, index in columns.items()}
    return Sheet(Table(grid, table.row, columns, ()), headings, nodes, faults)


def _holds_roles(table: Table, column: int) -> bool:
    """Whether most cells below a heading are S or R."""
    cells = [
        cell
        for row in range(table.row + 1, len(table.grid.rows))
        if not (cell := table.grid.cell(row, column)).is_blank
    ]
    return 2 * sum(bool(_role(cell)) for cell in cells) > len(cells)


def _role(cell: CellValue) -> str | None:
    """S, R, SR or "" for nothing; None for anything else."""
    text = normal(cell.text).lower().replace(" ", "")
    return _ROLES.get(text) if text else ""
