"""The three panes: the messages, the signals of one of them, and what there is at a glance."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Generic, Literal, TypeVar

from rich.text import Text
from textual.app import ComposeResult
from textual.containers import Vertical, VerticalScroll
from textual.widgets import DataTable, Static

from typedcan.monitor.glance import Alarm
from typedcan.monitor.picture import Picture
from typedcan.monitor.rows import MessageRow, SignalRow
from typedcan.monitor.view.columns import SIGNAL_COLUMNS, Column, message_columns, ordered
from typedcan.monitor.view.styles import ALERT, age, milliseconds, state_text
from typedcan.monitor.view.table import Table
from typedcan.shell.printing import printable
from typedcan.wire.protocol import Protocol

RowT = TypeVar("RowT", MessageRow, SignalRow)

Where = Literal["down", "up", "top", "end"]


class TablePane(Vertical, Generic[RowT]):
    """A table with a filter and an order.

    ``filter`` is the text that rows have to match, ``sort`` the column that they are sorted by;
    empty for all rows and for the order of the standard.
    """

    DEFAULT_CSS = "TablePane .title { height: 1; text-wrap: nowrap; text-overflow: ellipsis; }"

    def __init__(
        self, columns: Sequence[Column[RowT]], name_of: Callable[[RowT], str], *, id: str
    ) -> None:
        super().__init__(id=id)
        self.filter = ""
        self.sort = ""
        self.table: Table[RowT] = Table(columns, id=f"{id}-table")
        self._all_columns: Sequence[Column[RowT]] = columns
        self._name_of: Callable[[RowT], str] = name_of

    def compose(self) -> ComposeResult:
        """The table."""
        yield self.table

    def show_rows(self, rows: Sequence[RowT]) -> None:
        """Show the rows that match, in order."""
        matching = [row for row in rows if row.matches(self.filter)]
        sorted_rows = ordered(self._all_columns, matching, self.sort)
        self.table.show([self._name_of(row) for row in sorted_rows], sorted_rows)

    def sort_by_next(self) -> None:
        """Sort by the next column, after the last one not at all."""
        names = ["", *(column.name for column in self._all_columns if column.order)]
        self.sort = names[(names.index(self.sort) + 1) % len(names)]

    def move(self, where: Where) -> None:
        """Move the cursor."""
        if where == "down":
            self.table.action_cursor_down()
        elif where == "up":
            self.table.action_cursor_up()
        else:
            self.table.move_cursor(row=0 if where == "top" else self.table.row_count - 1)

    def step(self, rows: int) -> None:
        """Move the cursor by so many rows, from the end to the top and back."""
        if self.table.row_count:
            self.table.move_cursor(row=(self.table.cursor_row + rows) % self.table.row_count)

    def on_data_table_header_selected(self, event: DataTable.HeaderSelected) -> None:
        """A heading was clicked: sort by it."""
        event.stop()
        name = str(event.column_key.value)
        if any(column.name == name and column.order for column in self._all_columns):
            self.sort = "" if self.sort == name else name


class MessagesPane(TablePane[MessageRow]):
    """All messages of the protocol."""

    def __init__(self, protocol: Protocol) -> None:
        super().__init__(message_columns(protocol), lambda row: row.name, id="messages")

    def show(self, picture: Picture) -> None:
        """Show the messages of a picture."""
        self.show_rows(picture.messages)


class SignalsPane(TablePane[SignalRow]):
    """The signals of one message, and the message itself in the line above."""

    def __init__(self) -> None:
        super().__init__(SIGNAL_COLUMNS, lambda row: row.name, id="signals")
        self._title = Static(classes="title")

    def compose(self) -> ComposeResult:
        """The title and the table."""
        yield self._title
        yield self.table

    def show(self, picture: Picture, name: str | None) -> None:
        """Show the signals of a message; of none where there is no name."""
        row = next((row for row in picture.messages if row.name == name), None)
        self._title.update(_title(row) if row else "no message selected")
        self.show_rows(picture.signals(row.name) if row else ())


class GlancePane(VerticalScroll):
    """The alarms of all nodes, and what the glance at the protocol shows."""

    def __init__(self) -> None:
        super().__init__(id="glance")
        self._text = Static(markup=False)

    def compose(self) -> ComposeResult:
        """The text."""
        yield self._text

    def show(self, picture: Picture) -> None:
        """Show the alarms of a picture, and its look."""
        width = self.scrollable_content_region.width
        lines = list(_alarms(picture.alarms))
        for line in lines:
            line.truncate(width, overflow="ellipsis")
        lines += [Text(), picture.look.text(width)]
        self._text.update(Text("\n").join(lines))

    def move(self, where: Where) -> None:
        """Scroll."""
        if where == "down":
            self.scroll_down(animate=False)
        elif where == "up":
            self.scroll_up(animate=False)
        elif where == "top":
            self.scroll_home(animate=False)
        else:
            self.scroll_end(animate=False)


def _alarms(alarms: Sequence[Alarm]) -> Iterator[Text]:
    yield Text.assemble(("alarms", "bold underline"), f"  {len(alarms) or 'none'}")
    for alarm in alarms:
        rest = f"  {alarm.title or alarm.signal}, {alarm.message}, since {age(alarm.age)}"
        yield Text.assemble((printable(f"! {alarm.text}"), ALERT), printable(rest))


def _title(row: MessageRow) -> Text:
    period = milliseconds(row.period) or "on event"
    came = f", {age(row.age)} ago" if row.age is not None else ""
    route = f"{row.sender or '-'} > {', '.join(row.receivers) or '-'}"
    return Text.assemble(
        (row.name, "bold"),
        f"  {row.identifier}  {route}  {period}  ",
        state_text(row.state),
        came,
    )
