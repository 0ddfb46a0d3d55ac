"""A table whose rows are given anew several times a second: it keeps cursor and place.

And its columns: which of them fit, and what rows are sorted by.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, Generic, TypeVar

from rich.text import Text
from textual.binding import Binding, BindingType
from textual.widgets import DataTable

from typedcan.shell.printing import printable

RowT = TypeVar("RowT")

_GAP = 1


@dataclass(frozen=True, slots=True)
class Column(Generic[RowT]):
    """A column.

    Parameters
    ----------
    name
        Its heading, by which it is known too.
    width
        In characters; rows have that or less.
    rank
        Which columns go first where there is no room for all: those with the highest.
    cell
        What stands in it for a row.
    order
        What rows are sorted by; None where they are not sorted by this column. Numbers are sorted
        from high to low.
    grows
        Whether it takes the room that is left.
    """

    name: str
    width: int
    rank: int
    cell: Callable[[RowT], Text]
    order: Callable[[RowT], str | float] | None = None
    grows: bool = False


def fitting(columns: Sequence[Column[RowT]], width: int) -> list[Column[RowT]]:
    """The columns that there is room for, in their order; one may have grown."""
    kept: set[int] = set()
    left = width
    for index in sorted(range(len(columns)), key=lambda index: columns[index].rank):
        needed = columns[index].width + _GAP
        if needed <= left:
            kept.add(index)
            left -= needed
    return [
        replace(column, width=column.width + left) if column.grows else column
        for index, column in enumerate(columns)
        if index in kept
    ]


def ordered(
    columns: Sequence[Column[RowT]], rows: Sequence[RowT], name: str | None
) -> Sequence[RowT]:
    """The rows sorted by the column of that name; as they are where there is none."""
    order = next((column.order for column in columns if column.name == name), None)
    if order is None or not rows:
        return rows
    return sorted(rows, key=order, reverse=not isinstance(order(rows[0]), str))


class Table(DataTable[Text], Generic[RowT]):
    """Shows rows under the columns that fit.

    Parameters
    ----------
    columns
        All columns that there are.
    id
        Of the widget.
    """

    DEFAULT_CSS = """
    Table { height: 1fr; background: ansi_default; scrollbar-size: 1 1; overflow-x: hidden; }
    Table:focus { background-tint: ansi_default 0%; }
    Table > .datatable--header, Table:ansi > .datatable--header {
        background: ansi_default; color: ansi_default; text-style: bold underline;
    }
    Table > .datatable--cursor, Table:focus > .datatable--cursor {
        background: ansi_default; color: ansi_default; text-style: reverse;
    }
    Table > .datatable--hover { background: ansi_default; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("left", "app.step(-1)", show=False),
        Binding("right", "app.step(1)", show=False),
    ]

    def __init__(self, columns: Sequence[Column[RowT]], *, id: str) -> None:
        super().__init__(id=id, cursor_type="row", cell_padding=0)
        self._all_columns = columns
        self._shown_columns: list[Column[RowT]] = []
        self._names: list[str] = []
        self._cells: list[list[Text]] = []

    @property
    def selected(self) -> str | None:
        """The name of the row under the cursor; None in an empty table."""
        row = self.cursor_row
        return self._names[row] if 0 <= row < len(self._names) else None

    def show(self, names: Sequence[str], rows: Sequence[RowT]) -> None:
        """Show these rows; the cursor stays on the row of the same name."""
        columns = fitting(self._all_columns, self.scrollable_content_region.width)
        cells = [[_fitted(column.cell(row), column.width) for column in columns] for row in rows]
        if columns != self._shown_columns or list(names) != self._names:
            self._rebuild(columns, list(names), cells)
        else:
            self._update(cells)
        self._cells = cells

    def select(self, name: str) -> None:
        """Put the cursor on a row, if it is there."""
        if name in self._names:
            self.move_cursor(row=self._names.index(name))

    def _rebuild(
        self, columns: list[Column[RowT]], names: list[str], cells: list[list[Text]]
    ) -> None:
        selected, place = self.selected, self.scroll_offset
        self.clear(columns=columns != self._shown_columns)
        if columns != self._shown_columns:
            for column in columns:
                self.add_column(column.name, key=column.name, width=column.width + 1)
            self._shown_columns = columns
        for name, row in zip(names, cells, strict=True):
            self.add_row(*row, key=name)
        self._names = names
        self.scroll_to(*place, animate=False)
        if selected is not None:
            self.select(selected)

    def _update(self, cells: list[list[Text]]) -> None:
        for name, row, before in zip(self._names, cells, self._cells, strict=True):
            for column, cell, old in zip(self._shown_columns, row, before, strict=True):
                if cell != old or cell.style != old.style:
                    self.update_cell(name, column.name, cell)


def _fitted(cell: Text, width: int) -> Text:
    """The cell, as wide as its column at most, and a number at the right of it.

    Labels, units and titles come from files: what a terminal would obey in them is shown.
    """
    if not cell.plain.isprintable():
        cell.plain = printable(cell.plain)
    cell.truncate(width, overflow="ellipsis")
    if cell.justify == "right":
        cell.pad_left(width - len(cell))
        cell.justify = None
    return cell
