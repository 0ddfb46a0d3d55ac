"""The sheets of a checked workbook as cells that know where they stand."""

from __future__ import annotations

import io
import re
import warnings
import zipfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from openpyxl import load_workbook
from openpyxl.utils.cell import range_boundaries
from openpyxl.utils.exceptions import InvalidFileException

from dbcspec.matrix.guard import MOST_CELLS, check_workbook
from typedcan.model.errors import Location, ReadError

_ESCAPED = re.compile(r"_x(00[01][0-9A-Fa-f]|[Dd][89A-Fa-f][0-9A-Fa-f]{2}|[Ff]{3}[EeFf])_")


@dataclass(frozen=True, slots=True)
class CellValue:
    """A value as the workbook has it; ``kind`` is n, s, b, d, e (error), f (formula) or empty."""

    where: Location
    kind: str = ""
    value: object = None

    @property
    def text(self) -> str:
        """The value as text, "" for nothing; a whole number without a decimal point."""
        if self.value is None:
            return ""
        if isinstance(self.value, float) and self.value.is_integer() and abs(self.value) < 1e15:
            return str(int(self.value))
        return str(self.value)

    @property
    def is_blank(self) -> bool:
        """Whether nothing, or nothing but spaces, stands there."""
        return not self.text.strip()


@dataclass(frozen=True, slots=True)
class Grid:
    """A sheet; rows and columns count from 0 here, from 1 in locations."""

    file: str
    name: str
    rows: Sequence[Sequence[CellValue]]

    def where(self, row: int, column: int) -> Location:
        """The location of a cell."""
        return Location(f"{self.file}!{self.name}", row + 1, column + 1)

    def cell(self, row: int, column: int) -> CellValue:
        """A cell, an empty one outside the sheet."""
        if row < len(self.rows) and column < len(self.rows[row]):
            return self.rows[row][column]
        return CellValue(self.where(row, column))


def read_grids(path: Path, name: str) -> list[Grid]:
    """All sheets of a workbook; merged cells below their first one repeat its value.

    Raises `ReadError` for a file that is no sound workbook.
    """
    checked = check_workbook(path, name)
    try:
        with warnings.catch_warnings():
            # The library warns of parts it does not keep; none of them matters for reading.
            warnings.simplefilter("ignore")
            book = load_workbook(io.BytesIO(checked.data), read_only=True, keep_links=False)
            grids: list[Grid] = []
            for sheet in book.worksheets:
                sheet.reset_dimensions()
                rows = [
                    [(str(cell.data_type), cell.value) for cell in row] for row in sheet.iter_rows()
                ]
                grid = Grid(name, sheet.title, _located(name, sheet.title, rows))
                grids.append(_unmerged(grid, checked.merged.get(sheet.title, ())))
            book.close()
    except (
        AttributeError, IndexError, KeyError, OSError, SyntaxError, TypeError, ValueError,
        InvalidFileException, zipfile.BadZipFile,
    ) as error:  # fmt: skip
        # What the library raises for XML that is no workbook; it has no error of its own for it.
        reason = " ".join(str(error).split())[:100]
        raise ReadError(f"{name}: is damaged ({reason}); save it again as .xlsx") from None
    return grids


def _located(
    file: str, sheet: str, rows: Sequence[Sequence[tuple[str, object]]]
) -> list[list[CellValue]]:
    shown = f"{file}!{sheet}"
    return [
        [
            CellValue(
                Location(shown, line, column),
                kind if value is not None else "",
                _ESCAPED.sub(_character, value) if isinstance(value, str) else value,
            )
            for column, (kind, value) in enumerate(row, start=1)
        ]
        for line, row in enumerate(rows, start=1)
    ]


def _character(match: re.Match[str]) -> str:
    """What XML cannot hold, as Excel writes it."""
    return chr(int(match[1], 16))


def _unmerged(grid: Grid, ranges: Iterable[str]) -> Grid:
    """Only downwards: a cell merged over columns belongs to the first of them."""
    rows = [list(row) for row in grid.rows]
    steps = 0
    for reference in ranges:
        first_column, first_row, _, last_row = range_boundaries(reference)
        if first_column is None or first_row is None or last_row is None:
            continue
        top = grid.cell(first_row - 1, first_column - 1)
        for row in range(first_row, min(last_row, len(rows))):
            steps += 1
            if steps > MOST_CELLS:
                raise ReadError(f"{grid.file}: has too many merged cells")
            missing = first_column - len(rows[row])
            rows[row].extend(
                CellValue(grid.where(row, len(rows[row]) + number)) for number in range(missing)
            )
            where = rows[row][first_column - 1].where
            rows[row][first_column - 1] = CellValue(where, top.kind, top.value)
    return Grid(grid.file, grid.name, rows)
