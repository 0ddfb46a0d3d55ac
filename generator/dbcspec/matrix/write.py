"""The model to the Excel CAN matrix: the workbook in which engineers read and review a protocol."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from openpyxl import Workbook
from openpyxl.utils import get_column_letter
from openpyxl.worksheet.hyperlink import Hyperlink
from openpyxl.worksheet.worksheet import Worksheet

from dbcspec.matrix.bits import add_bit_sheet, bit_sheet_names
from dbcspec.matrix.cells import A3, Value, add_styles, fit_to_page, put, set_widths
from dbcspec.matrix.columns import (
    CODES_HEADING,
    ENGLISH_CODES_HEADING,
    SIGNAL_NAME_HEADING,
    code_blocks,
    columns_of,
    node_names,
)
from dbcspec.matrix.headings import MATRIX as HEADINGS
from dbcspec.matrix.headings import meanings
from dbcspec.matrix.sheets import add_cover, add_errata, add_nodes
from dbcspec.matrix.workbook import workbook_bytes
from typedcan.model.protocol import Aspect, Message, Protocol, Signal

COVER, MATRIX, NODES, ERRATA = "封面 Cover", "矩阵 Matrix", "节点与总线 Nodes", "勘误 Errata"

_HEAD_HEIGHT = 40.0
_LINE_HEIGHT = 12.0
_TALLEST_ROW = 243.0
_NODE_WIDTH = 6.0


def emit_matrix(protocol: Protocol) -> bytes:
    """Render a protocol as an .xlsx workbook; the same protocol makes the same bytes.

    Columns for what the protocol cannot say (`Protocol.carries`) are left out.
    """
    book = Workbook()
    add_styles(book)
    cover = book.active
    assert isinstance(cover, Worksheet)
    cover.title = COVER
    matrix: Worksheet = book.create_sheet(MATRIX)
    with_errata = Aspect.REFERENCES in protocol.carries
    fixed = [MATRIX, NODES, *([ERRATA] if with_errata else [])]
    names = bit_sheet_names(protocol, [COVER, *fixed])
    _MatrixSheet(matrix, protocol, names).fill()
    add_nodes(book.create_sheet(NODES), protocol)
    if with_errata:
        add_errata(book.create_sheet(ERRATA), protocol)
    for index, name in names.items():
        add_bit_sheet(book, name, protocol.messages[index], MATRIX)
    add_cover(cover, protocol, [*fixed, *names.values()])
    return workbook_bytes(book)


def not_in_matrix(protocol: Protocol) -> Iterator[str]:
    """What of a protocol no matrix has room for, a line each."""
    attributes = [
        *protocol.attributes,
        *(each for node in protocol.nodes for each in node.attributes),
        *(each for message in protocol.messages for each in message.attributes),
        *(each for _, signal in protocol.signals() for each in signal.attributes),
    ]
    found = {
        "attributes": len(attributes),
        "attribute definitions": len(protocol.definitions),
        "signal groups": sum(len(each.groups) for each in protocol.messages),
        "environment variables": len(protocol.variables),
    }
    said = ", ".join(f"{count} {what}" for what, count in found.items() if count)
    if said:
        yield f"not in the matrix: {said}"


class _MatrixSheet:
    """Fills the one sheet that has everything: a row per message, then a row per signal."""

    def __init__(self, sheet: Worksheet, protocol: Protocol, bit_sheets: Mapping[int, str]) -> None:
        self._sheet = sheet
        self._protocol = protocol
        self._bit_sheets = bit_sheets
        self._columns = columns_of(protocol)
        self._nodes = node_names(protocol)
        self._row = 1

    def fill(self) -> None:
        """Write headings and rows, then what makes a sheet usable."""
        self._headings()
        for index, message in enumerate(self._protocol.messages):
            self._message(message, self._bit_sheets.get(index))
            for signal in message.signals:
                self._signal(message, signal)
        sheet = self._sheet
        width = len(self._columns) + len(self._nodes)
        after_name = 2 + self._index(SIGNAL_NAME_HEADING)
        sheet.freeze_panes = f"{get_column_letter(after_name)}2"
        sheet.auto_filter.ref = f"A1:{get_column_letter(width)}{self._row}"
        sheet.print_title_rows = "1:1"
        fit_to_page(sheet, A3)

    def _index(self, english: str) -> int:
        return next(i for i, column in enumerate(self._columns) if column.english == english)

    def _headings(self) -> None:
        for number, column in enumerate(self._columns, start=1):
            put(self._sheet, 1, number, column.heading, "swap_head")
        for number, node in enumerate(self._nodes, start=1 + len(self._columns)):
            # A node called like a column, in whatever matrix, would be taken for it.
            heading = f"节点: {node}" if meanings(node, HEADINGS) else node
            put(self._sheet, 1, number, heading, "swap_head")
        widths = [*(column.width for column in self._columns), *(_NODE_WIDTH for _ in self._nodes)]
        set_widths(self._sheet, widths)
        self._sheet.row_dimensions[1].height = _HEAD_HEIGHT

    def _message(self, message: Message, bit_sheet: str | None) -> None:
        values = [column.of_message(message) for column in self._columns]
        self._write(values, "swap_message")
        for number, node in enumerate(self._nodes, start=1 + len(values)):
            self._role(number, _role_of(node, message, message.receivers), "swap_message")
        if bit_sheet:
            cell = put(self._sheet, self._row, 1, message.name, "swap_message")
            cell.hyperlink = Hyperlink(ref=cell.coordinate, location=f"'{bit_sheet}'!A1")

    def _signal(self, message: Message, signal: Signal) -> None:
        values = [column.of_signal(message, signal) for column in self._columns]
        self._write(values, "swap_text")
        for number in (1, 2):
            self._sheet.cell(self._row, number).style = "swap_repeat"
        for number, node in enumerate(self._nodes, start=1 + len(values)):
            self._role(number, _role_of(node, message, signal.receivers), "swap_text")
        self._more_codes(signal)

    def _more_codes(self, signal: Signal) -> None:
        """Codes that do not fit into one cell go on below it, in rows without a name."""
        blocks = {
            self._index(heading): code_blocks(signal, english=english)[1:]
            for heading, english in ((CODES_HEADING, False), (ENGLISH_CODES_HEADING, True))
        }
        for step in range(max(map(len, blocks.values()))):
            values: list[Value] = [None] * len(self._columns)
            for index, texts in blocks.items():
                values[index] = texts[step] if step < len(texts) else None
            self._write(values, "swap_text")

    def _write(self, values: list[Value], style: str) -> None:
        """The next row, as tall as its text."""
        self._row += 1
        lines = 1
        for number, (value, column) in enumerate(zip(values, self._columns, strict=True), start=1):
            put(self._sheet, self._row, number, value, style)
            if isinstance(value, str):
                lines = max(lines, _lines(value, column.width))
        self._sheet.row_dimensions[self._row].height = min(_TALLEST_ROW, 3 + _LINE_HEIGHT * lines)

    def _role(self, column: int, letters: str, style: str) -> None:
        named = "swap_sends" if "S" in letters else "swap_receives" if letters else style
        put(self._sheet, self._row, column, letters or None, named)


def _role_of(node: str, message: Message, receivers: Sequence[str]) -> str:
    """S, S2 for who sends it beside that one, R, both or nothing."""
    parts = {
        "S": node == message.sender,
        "S2": node in message.other_senders,
        "R": node in receivers,
    }
    return "/".join(letter for letter, there in parts.items() if there)


def _lines(text: str, width: float) -> int:
    """How many lines a text takes in a column; Chinese characters are two wide."""
    return sum(
        max(1, -(-sum(2 if ord(char) > 0x2E7F else 1 for char in line) // int(width)))
        for line in text.split("\n")
    )
