"""The pack as text: its values in blocks beside each other, and its cells as a map."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import zip_longest

from rich.text import Text

from swapcan.glance.cells import Cell, CellMap
from swapcan.glance.pack import Item, Pack, Section
from swapcan.transfer import Reading
from typedcan.model.signal_state import SignalState
from typedcan.monitor.view.styles import ALERT, mark_text
from typedcan.shell.printing import printable

_BLOCK = 33
"""Characters of one block and the gap after it."""

_LABEL = 11
_BARS = "▁▂▃▄▅▆▇█"
_COLOURS = ("blue", "blue", "cyan", "", "", "magenta", "red", "red")
_LEAST_SPAN = 0.02
"""Volts that the map shows at least: a millivolt of difference is none."""


def pack_text(pack: Pack, cells: CellMap, vin: str, pack_code: str, width: int) -> Text:
    """All of it, in lines of that many characters at most."""
    lines = [
        *_blocks(pack, width),
        Text(f"VIN {vin or '-'}    pack code {pack_code or '-'}"),
        Text(),
        *_cells(cells, width),
    ]
    for line in lines:
        line.truncate(width, overflow="ellipsis")
    return Text("\n").join(lines)


def _blocks(pack: Pack, width: int) -> Iterator[Text]:
    beside = max(1, width // _BLOCK)
    for start in range(0, len(pack.sections), beside):
        row = pack.sections[start : start + beside]
        for parts in zip_longest(*(_block(section) for section in row)):
            line = Text()
            for part in (part or Text() for part in parts):
                part.truncate(_BLOCK - 1, overflow="ellipsis")
                part.pad_right(_BLOCK - part.cell_len)  # a Chinese character takes two
                line.append_text(part)
            line.rstrip()
            yield line
        yield Text()


def _block(section: Section) -> list[Text]:
    return [Text(section.title, "bold underline"), *map(_item, section.items)]


def _item(item: Item) -> Text:
    line = Text(f"{item.label:<{_LABEL}}")
    text = printable(item.text)  # labels and units come from a file
    if item.mark == "alarm":
        return line.append(f"! {text}", ALERT)
    line.append(f"{text or '-'} ")
    # What is invalid says so itself.
    return line.append_text(mark_text("" if item.mark == "invalid" else item.mark))


def _cells(cells: CellMap, width: int) -> Iterator[Text]:
    yield Text("cells", "bold underline")
    low, high = cells.lowest, cells.highest
    if low is None or high is None:
        yield Text("no cell voltage yet")
        return
    yield Text(_coverage(cells))
    yield Text(f"{_BARS[0]} {_cell(low)}    {_BARS[-1]} {_cell(high)}    x invalid  · not received")
    for csc, readings in cells.groups.items():
        yield from _group(csc, readings, (low.volts, high.volts), width)


def _coverage(cells: CellMap) -> str:
    if cells.total is None:
        return f"partial: {cells.received} cells received, their number is not known"
    partial = "" if cells.is_complete else "partial: "
    return f"{partial}{cells.received} of {cells.total} cells received in the last second"


def _cell(cell: Cell) -> str:
    return f"{cell.volts:.3f} V, CSC {cell.csc} no. {cell.number}"


def _group(
    csc: int, readings: Sequence[Reading | None], limits: tuple[float, float], width: int
) -> Iterator[Text]:
    heading = f"CSC {csc:<3} "
    room = max(width - len(heading), 1)
    for start in range(0, len(readings), room):
        line = Text(" " * len(heading) if start else heading)
        for reading in readings[start : start + room]:
            line.append(*_bar(reading, *limits))
        yield line


def _bar(reading: Reading | None, low: float, high: float) -> tuple[str, str]:
    if reading is None:
        return "·", ""
    if isinstance(reading, SignalState):
        return "x", ALERT
    span = max(high - low, _LEAST_SPAN)
    bottom = (low + high - span) / 2
    level = min(int((reading - bottom) / span * len(_BARS)), len(_BARS) - 1)
    return _BARS[level], _COLOURS[level]
