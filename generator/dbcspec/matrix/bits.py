"""The bit-matrix sheets: which bits of a message each signal takes, in colours."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from itertools import groupby

from openpyxl import Workbook
from openpyxl.styles import Alignment
from openpyxl.worksheet.hyperlink import Hyperlink
from openpyxl.worksheet.worksheet import Worksheet

from dbcspec.matrix.cells import A4, BIT_STYLES, fit_to_page, put, set_widths
from typedcan.model.layout import bits
from typedcan.model.protocol import Message, Protocol, Signal

MOST_SHEETS = 200
"""A protocol with more messages gets no bit matrices: Excel would be slow and the tabs useless."""

_MOST_BYTES = 64
_LONGEST_SHEET_NAME = 31
_NAMES_SHOWN = 3
_FIRST_ROW = 4


def bit_sheet_names(protocol: Protocol, taken: Iterable[str]) -> dict[int, str]:
    """The sheet name of each message with a bit matrix, by its index in the protocol."""
    used = {"history", *(name.lower() for name in taken)}
    names: dict[int, str] = {}
    if len(protocol.messages) > MOST_SHEETS:
        return names
    for index, message in enumerate(protocol.messages):
        if not 0 < message.length <= _MOST_BYTES:
            continue
        base = re.sub(r"[\[\]:*?/\\\x00-\x1f]", "_", message.name).strip("'") or "Message"
        name, number = base[:_LONGEST_SHEET_NAME], 1
        while name.lower() in used:
            number += 1
            suffix = f"~{number}"
            name = base[: _LONGEST_SHEET_NAME - len(suffix)] + suffix
        used.add(name.lower())
        names[index] = name
    return names


def add_bit_sheet(book: Workbook, name: str, message: Message, back: str) -> None:
    """Add the sheet of one message, with a link back to the sheet ``back``."""
    sheet: Worksheet = book.create_sheet(name)
    set_widths(sheet, (9, *(17,) * 8))
    digits = 8 if message.extended else 3
    title = put(sheet, 1, 1, f"{message.name}  0x{message.frame_id:0{digits}X}", "swap_title")
    title.alignment = Alignment(wrap_text=False)
    text = "  ".join(filter(None, (message.english, message.title)))
    put(sheet, 2, 1, text, "swap_title").style = "Normal"
    link = put(sheet, 1, 9, back, "swap_link")
    link.hyperlink = Hyperlink(ref=link.coordinate, location=f"'{back}'!A1")
    put(sheet, 3, 1, "字节\nByte", "swap_head")
    sheet.row_dimensions[3].height = 26
    for bit in range(8):
        put(sheet, 3, 9 - bit, bit, "swap_head")
    taken = _taken(message)
    styles = {
        signal.name: BIT_STYLES[index % len(BIT_STYLES)]
        for index, signal in enumerate(message.signals)
    }
    for byte in range(message.length):
        _byte_row(sheet, byte, taken, styles)
    sheet.freeze_panes = f"B{_FIRST_ROW}"
    fit_to_page(sheet, A4)


def _taken(message: Message) -> dict[int, list[Signal]]:
    """The signals on each bit of the frame."""
    taken: dict[int, list[Signal]] = {}
    for signal in message.signals:
        for bit in bits(signal):
            taken.setdefault(bit, []).append(signal)
    return taken


def _byte_row(
    sheet: Worksheet,
    byte: int,
    taken: Mapping[int, list[Signal]],
    styles: Mapping[str, str],
) -> None:
    row = _FIRST_ROW + byte
    put(sheet, row, 1, byte, "swap_head")
    sheet.row_dimensions[row].height = 32
    for names, low, high in _runs(byte, taken):
        text = _text(taken.get(8 * byte + high, []), 8 * byte + low, 8 * byte + high)
        first, last = 9 - high, 9 - low
        for column in range(first, last + 1):
            style = styles[names[0]] if names else "swap_bit"
            put(sheet, row, column, text if column == first else None, style)
        if last > first:
            sheet.merge_cells(start_row=row, end_row=row, start_column=first, end_column=last)


def _runs(byte: int, taken: Mapping[int, list[Signal]]) -> Iterator[tuple[list[str], int, int]]:
    """Neighbouring bits with the same signals, from bit 7 down: names, lowest and highest bit."""

    def names(bit: int) -> list[str]:
        return [signal.name for signal in taken.get(8 * byte + bit, ())]

    for here, group in groupby(range(7, -1, -1), key=names):
        run = list(group)
        yield here, run[-1], run[0]


def _text(signals: list[Signal], low: int, high: int) -> str:
    """The names; a signal that does not lie in this run alone shows which of its bits do."""
    names = [signal.name for signal in signals]
    shown = "\n".join(names[:_NAMES_SHOWN])
    if len(names) > _NAMES_SHOWN:
        return f"{shown}\n… {len(names) - _NAMES_SHOWN} more"
    if len(names) == 1:
        places = bits(signals[0])
        part = sorted((places.index(low), places.index(high)))
        if part[1] - part[0] + 1 != len(places):
            return f"{shown}\n[{part[1]}:{part[0]}]"
    return shown
