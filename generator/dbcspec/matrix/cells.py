"""Cells of the Excel matrix: values that stay what they are, and the styles they wear."""

from __future__ import annotations

import re
from collections.abc import Iterable
from decimal import Decimal

from openpyxl import Workbook
from openpyxl.cell.cell import Cell
from openpyxl.styles import Alignment, Border, Font, NamedStyle, PatternFill, Side
from openpyxl.utils import get_column_letter
from openpyxl.worksheet.properties import PageSetupProperties
from openpyxl.worksheet.worksheet import Worksheet

from typedcan.model.protocol import Signal

Value = str | int | Decimal | None

A3, A4 = 8, 9
"""Paper sizes as Excel numbers them."""

LONGEST_TEXT = 32_767
"""UTF-16 units that a cell of Excel holds."""

_EXACT_DIGITS = 15
_RISKY_START = ("=", "+", "-", "@", "\t", "\r", "\n")
_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\ud800-\udfff\ufffe\uffff]|_x(?=[0-9A-Fa-f]{4}_)")
_FONT = "Arial"
_BIT_COLOURS = (
    "FFBDD7EE", "FFC6E0B4", "FFFFE699", "FFF8CBAD", "FFD9D2E9", "FFB7E1CD", "FFFCE4D6", "FFD0CECE",
    "FFCFE2F3", "FFEAD1DC", "FFE2EFDA", "FFFFF2CC",
)  # fmt: skip
BIT_STYLES = tuple(f"swap_bit_{index}" for index in range(len(_BIT_COLOURS)))
"""The styles of the signals in a bit matrix, one colour each."""

_GREY, _BLUE = "FF808080", "FF0563C1"
_LINE = Side(style="thin", color="FFBFBFBF")
_EDGES = Border(left=_LINE, right=_LINE, top=_LINE, bottom=_LINE)
_TOP_LEFT = Alignment(vertical="top", wrap_text=True)
_CENTRED = Alignment(horizontal="center", vertical="center", wrap_text=True)
_TOP_CENTRED = Alignment(horizontal="center", vertical="top")


def add_styles(book: Workbook) -> None:
    """Register the named styles that `put` is given."""
    for name, font, colour, alignment in (
        ("swap_title", Font(name=_FONT, size=16, bold=True), "", Alignment(wrap_text=True)),
        ("swap_head", Font(name=_FONT, size=9, bold=True, color="FFFFFFFF"), "FF1F4E78", _CENTRED),
        ("swap_message", Font(name=_FONT, size=9, bold=True), "FFDDEBF7", _TOP_LEFT),
        ("swap_text", Font(name=_FONT, size=9), "", _TOP_LEFT),
        ("swap_repeat", Font(name=_FONT, size=9, color=_GREY), "", _TOP_LEFT),
        (
            "swap_link",
            Font(name=_FONT, size=9, color=_BLUE, u="single"),
            "",
            _TOP_LEFT,
        ),
        ("swap_sends", Font(name=_FONT, size=9, bold=True), "FFF8CBAD", _TOP_CENTRED),
        ("swap_receives", Font(name=_FONT, size=9), "FFC6E0B4", _TOP_CENTRED),
        ("swap_bit", Font(name=_FONT, size=8), "", _CENTRED),
        *(
            (name, Font(name=_FONT, size=8), colour, _CENTRED)
            for name, colour in zip(BIT_STYLES, _BIT_COLOURS, strict=True)
        ),
    ):
        style = NamedStyle(name=name, font=font, alignment=alignment)
        if name not in ("swap_title", "swap_link"):
            style.border = _EDGES
        if colour:
            style.fill = PatternFill("solid", fgColor=colour)
        book.add_named_style(style)


def put(sheet: Worksheet, row: int, column: int, value: Value, style: str = "swap_text") -> Cell:
    """Write one value: numbers as numbers where Excel keeps them exact, the rest as text.

    Excel counts with 15 digits; a longer number is written as text. Text never becomes a formula,
    also not when somebody edits the cell. Text longer than a cell is cut and ends in "…".
    """
    cell = sheet.cell(row, column)
    assert isinstance(cell, Cell)
    cell.style = style
    if isinstance(value, Decimal):
        value = _number(value)
    if isinstance(value, int) and abs(value) >= 10**_EXACT_DIGITS:
        value = str(value)
    if isinstance(value, str):
        _put_text(cell, value)
    elif value is not None:
        cell.value = value
    return cell


def put_table(
    sheet: Worksheet, row: int, headings: Iterable[str], rows: Iterable[Iterable[Value]]
) -> int:
    """Write a table with its headings at a row and return the row after it."""
    for column, heading in enumerate(headings, start=1):
        put(sheet, row, column, heading, "swap_head")
    sheet.row_dimensions[row].height = 28
    for values in rows:
        row += 1
        for column, value in enumerate(values, start=1):
            put(sheet, row, column, value)
    return row + 1


def set_widths(sheet: Worksheet, widths: Iterable[float]) -> None:
    """Set the widths of the first columns, in characters."""
    for index, width in enumerate(widths, start=1):
        sheet.column_dimensions[get_column_letter(index)].width = width


def fit_to_page(sheet: Worksheet, paper: int) -> None:
    """Print a sheet landscape, as wide as the paper."""
    sheet.page_setup.orientation = "landscape"
    sheet.page_setup.paperSize = paper
    sheet.page_setup.fitToHeight = 0
    sheet.sheet_properties.pageSetUpPr = PageSetupProperties(fitToPage=True)


def raw_text(value: int, signal: Signal, digits: int = 1) -> str:
    """A raw value as hexadecimal text of at least so many digits; negative ones as their bits.

    A value that the bits of the signal cannot hold, as some DBC files have it, is written as
    ``200 (dec)``.
    """
    low, high = signal.raw_limits
    if low <= value < 0:
        value += 1 << signal.length
    elif value < 0 or (signal.signed and value > high):
        return f"{value} (dec)"
    return f"0x{value:0{digits}X}"


def _number(value: Decimal) -> Value:
    """The number as Excel shall hold it: an int, a decimal, or text where it would be rounded."""
    plain = format(value, "f")
    if "." in plain:
        plain = plain.rstrip("0").rstrip(".")
    plain = "0" if plain == "-0" else plain
    if len(plain.strip("-").replace(".", "").strip("0")) > _EXACT_DIGITS:
        return plain
    return Decimal(plain) if "." in plain else int(plain)


def _put_text(cell: Cell, text: str) -> None:
    text = _CONTROL.sub(_escaped, text)
    if len(text.encode("utf-16-le")) // 2 > LONGEST_TEXT:
        cut = text.encode("utf-16-le")[: 2 * (LONGEST_TEXT - 1)]
        text = cut.decode("utf-16-le", "ignore") + "…"
    cell.value = text
    # The library takes "=…" for a formula and "#N/A" for an error; both are text here.
    cell.data_type = "s"
    if text.startswith(_RISKY_START) or text.startswith("_x000D_"):
        cell.quotePrefix = True


def _escaped(match: re.Match[str]) -> str:
    """A character that XML cannot hold, as Excel writes it."""
    found = match.group()
    return "_x005F_x" if found == "_x" else f"_x{ord(found):04X}_"
