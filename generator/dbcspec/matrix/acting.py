"""The cells of the matrix that say which codes of a signal act, and which one is safe."""

from __future__ import annotations

from dbcspec.matrix.grid import CellValue
from dbcspec.matrix.headings import normal
from dbcspec.matrix.row import Row
from dbcspec.matrix.values import CellError, raw_of, raws_of, text_of
from typedcan.model.acting import ActingCodes

ACTING_COLUMNS = ("acting", "safe", "acts_as", "acting_reference")
"""The columns that together say what acts."""

_NONE: tuple[int, ...] = ()
_KINDS = {
    **dict.fromkeys(("", "command", "命令", "指令"), False),
    **dict.fromkeys(("report", "报告", "反馈"), True),
}


def acting_of(row: Row, *, length: int, signed: bool) -> ActingCodes | None:
    """The codes that act, None where none does; what contradicts itself is a fault of the sheet."""
    if not (row.sheet.has("acting") and row.sheet.has("safe")):
        return None
    before = len(row.sheet.faults)

    def codes(cell: CellValue) -> tuple[int, ...]:
        hexadecimal = row.is_hex("acting")
        return raws_of(cell, length=length, signed=signed, hexadecimal=hexadecimal)

    def code(cell: CellValue) -> int | None:
        return raw_of(cell, length=length, signed=signed, hexadecimal=row.is_hex("safe"))

    acting = row.read("acting", codes, _NONE)
    safe = row.read("safe", code, None)
    reports = row.read("acts_as", _reports, False)  # noqa: FBT003 - what stands instead
    reference = row.text("acting_reference")
    if len(row.sheet.faults) > before:
        return None
    if contradiction := _contradiction(row, acting, safe):
        row.fault(*contradiction)
    if not acting or safe is None:
        return None
    return ActingCodes(codes=acting, safe=safe, reports=reports, reference=reference)


def _contradiction(row: Row, acting: tuple[int, ...], safe: int | None) -> tuple[str, str] | None:
    """The first cell at fault, and why."""
    if acting and safe is None:
        return "safe", "values act here: write the safe value that ends what they begin"
    if safe is not None and safe in acting:
        return "safe", f"the safe value {safe} acts itself"
    for key in () if acting else ACTING_COLUMNS[1:]:
        if not row.cell(key).is_blank:
            return key, "no value acts here: write the acting values, or leave this empty"
    return None


def _reports(cell: CellValue) -> bool:
    text = normal(text_of(cell)).lower()
    if text not in _KINDS:
        raise CellError(f"expected Command or Report, not {text[:40]!r}")
    return _KINDS[text]
