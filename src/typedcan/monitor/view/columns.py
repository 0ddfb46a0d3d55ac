"""The columns of the tables: which there are, which of them fit, and what rows are sorted by."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Generic, TypeVar

from rich.text import Text

from typedcan.monitor.rows import MessageRow, SignalRow
from typedcan.monitor.view.styles import WARNING, age, mark_text, milliseconds, number, state_text
from typedcan.wire.protocol import Protocol

RowT = TypeVar("RowT")

_GAP = 1

_LONGEST_NAME = 32
"""Characters; what is longer is cut."""


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
