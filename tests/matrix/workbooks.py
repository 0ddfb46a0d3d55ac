"""Small workbooks as other people write them, and changes to ours, all made with plain openpyxl."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import openpyxl
from openpyxl.worksheet.worksheet import Worksheet

MATRIX = "矩阵 Matrix"
HEADINGS = (
    "Msg Name",
    "Msg ID",
    "Msg Length",
    "Signal Name",
    "Byte Order",
    "Start Bit",
    "Bit Length",
    "ECU",
    "DASH",
)
SPEED = ("Wheels", "0x123", 8, "Speed", "Intel", 0, 16, "S", "R")


def save(path: Path, rows: Sequence[Sequence[object]], title: str = "CAN") -> Path:
    """Write rows as the only sheet of a workbook."""
    book = openpyxl.Workbook()
    sheet = book.active
    assert isinstance(sheet, Worksheet)
    sheet.title = title
    for row in rows:
        sheet.append(list(row))
    book.save(path)
    return path


def small(path: Path, **cells: object) -> Path:
    """A matrix of one signal; ``cells`` adds columns or replaces cells: heading to value.

    Underscores in headings stand for spaces.
    """
    row = dict(zip(HEADINGS, SPEED, strict=True))
    row |= {heading.replace("_", " "): value for heading, value in cells.items()}
    return save(path, [list(row), list(row.values())])


def edited(data: bytes, path: Path, edit: Callable[[Worksheet], None]) -> Path:
    """Our workbook with its matrix sheet changed as a person would in Excel."""
    book = openpyxl.load_workbook(io.BytesIO(data))
    edit(book[MATRIX])
    book.save(path)
    return path


def columns(sheet: Worksheet) -> dict[str, int]:
    """The number of each column of our matrix by its English heading."""
    headings = next(sheet.iter_rows(max_row=1, values_only=True))
    return {str(text).split("\n")[-1]: number for number, text in enumerate(headings, start=1)}


def signal_rows(sheet: Worksheet) -> dict[str, int]:
    """The number of the row of each signal in our matrix."""
    names = columns(sheet)["Signal Name"]
    found = ((sheet.cell(row, names).value, row) for row in range(2, sheet.max_row + 1))
    return {str(name): row for name, row in found if name}


def repacked(data: bytes, path: Path, parts: Mapping[str, bytes]) -> Path:
    """A zip file with parts replaced or added, compressed."""
    with (
        zipfile.ZipFile(io.BytesIO(data)) as source,
        zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as target,
    ):
        for name in source.namelist():
            if name not in parts:
                target.writestr(name, source.read(name))
        for name, text in parts.items():
            target.writestr(name, text)
    return path
