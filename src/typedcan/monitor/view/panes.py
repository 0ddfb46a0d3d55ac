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
from typedcan.monitor.view.styles import (
    ALERT,
    WARNING,
    age,
    mark_text,
    milliseconds,
    number,
    state_text,
)
from typedcan.monitor.view.table import Column, Table, ordered
from typedcan.shell.printing import printable
from typedcan.wire.protocol import Protocol

RowT = TypeVar("RowT", MessageRow, SignalRow)

_LONGEST_NAME = 32
"""Characters; what is longer is cut."""

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


def _widest(least: int, names: Sequence[str]) -> int:
    return min(max([least, *map(len, names)]), _LONGEST_NAME)


def _by_identifier(row: MessageRow) -> str:
    return f"{row.frame_id:08X}"


def _receivers(row: MessageRow) -> str:
    return next(iter(row.receivers), "")


def _period(row: MessageRow) -> Text:
    return number(milliseconds(row.period) or "on event")


def _measured(row: MessageRow, seconds: float | None) -> Text:
    """A measured time; between events it means little."""
    return number("" if row.period is None else milliseconds(seconds))


def _faults(row: MessageRow) -> Text:
    count = row.fault_count
    return number(f"! {count}" if count else "0", WARNING if count else "")


def _wrong(row: MessageRow) -> Text:
    return number(f"! {row.wrong}" if row.wrong else "0")


def _value(row: SignalRow) -> Text:
    return Text(" ".join(filter(None, (row.value, row.unit if row.value else "", row.label))))


def _seconds(value: float | None) -> float:
    return -1.0 if value is None else value


def message_columns(protocol: Protocol) -> tuple[Column[MessageRow], ...]:
    """Those of messages; "signals" is how many of them say that something is wrong."""
    name = _widest(14, [kind.NAME for kind in protocol.messages])
    sender = _widest(4, [kind.SENDER for kind in protocol.messages])
    return (
        Column("message", name, 0, lambda row: Text(row.name), lambda row: row.name),
        Column("id", 10, 7, lambda row: Text(row.identifier), _by_identifier),
        Column("from", sender, 8, lambda row: Text(row.sender), lambda row: row.sender),
        Column("state", 12, 1, lambda row: state_text(row.state), lambda row: row.state),
        Column("frames", 8, 2, lambda row: number(str(row.frames)), lambda row: row.frames),
        Column("period", 9, 4, _period, lambda row: _seconds(row.period)),
        Column("mean", 9, 3, lambda row: _measured(row, row.mean), lambda row: _seconds(row.mean)),
        Column(
            "jitter",
            9,
            9,
            lambda row: _measured(row, row.jitter),
            lambda row: _seconds(row.jitter),
        ),
        Column(
            "worst",
            9,
            10,
            lambda row: _measured(row, row.worst),
            lambda row: _seconds(row.worst),
        ),
        Column("age", 7, 5, lambda row: number(age(row.age)), lambda row: _seconds(row.age)),
        Column("faults", 7, 6, _faults, lambda row: row.fault_count),
        Column("signals", 7, 11, _wrong, lambda row: row.wrong),
        Column("to", 8, 12, lambda row: Text(", ".join(row.receivers)), _receivers),
    )


SIGNAL_COLUMNS: tuple[Column[SignalRow], ...] = (
    Column("signal", 30, 0, lambda row: Text(row.name), lambda row: row.name),
    Column("value", 24, 1, _value, grows=True),
    Column("mark", 14, 2, lambda row: mark_text(row.mark), lambda row: row.mark or "~"),
    Column("age", 7, 3, lambda row: number(age(row.age))),
    Column("title", 50, 4, lambda row: Text(row.title), lambda row: row.title),
)
"""Those of signals."""
