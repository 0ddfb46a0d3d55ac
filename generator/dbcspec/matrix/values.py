"""What the text or number in a cell means; each function raises `CellError` with what to do."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from decimal import Decimal

from dbcspec.matrix.grid import CellValue
from dbcspec.matrix.headings import normal

_DECIMAL = re.compile(r"[+-]?\d{1,400}(?:\.\d{0,400})?(?:[eE][+-]?\d{1,3})?")
_HEX = re.compile(r"(?:0[xX])?([0-9A-Fa-f]{1,16})[hH]?")
_PLAIN_DECIMAL = re.compile(r"([+-]?\d{1,20}) ?\(dec\)")
_CODE_LINE = re.compile(
    r"\s*(0[xX][0-9A-Fa-f]{1,16}|[+-]?\d{1,20} ?\(dec\)|[+-]?\d{1,20})\s*[:：=＝]\s*(.*)", re.DOTALL
)
_KINDS = {"f": "a formula", "e": "an error", "b": "a truth value", "d": "a date"}


class CellError(Exception):
    """A cell that cannot be understood; the text says why."""


def text_of(cell: CellValue) -> str:
    """The text of a cell, as it stands."""
    if cell.kind in _KINDS:
        raise CellError(f"{_KINDS[cell.kind]} stands here: write the text itself")
    return cell.text


def decimal_of(cell: CellValue) -> Decimal | None:
    """The number of a cell, also one stored as text; None where it is empty."""
    if cell.kind in _KINDS:
        raise CellError(f"{_KINDS[cell.kind]} stands here: write the number itself")
    if cell.is_blank:
        return None
    if isinstance(cell.value, int | float):
        # As Excel shows it: the last digits of a calculated value are noise.
        number = Decimal(
            format(cell.value, ".15g") if isinstance(cell.value, float) else cell.value
        )
        if not number.is_finite():
            raise CellError(f"{cell.value} is no number to count with")
        return number
    text = normal(cell.text).replace("−", "-")
    if not _DECIMAL.fullmatch(text):
        raise CellError(f"expected a number such as 0.1, not {_short(cell.text)}")
    return Decimal(text)


def whole_of(cell: CellValue, low: int, high: int) -> int | None:
    """The whole number of a cell between two limits; None where it is empty."""
    number = decimal_of(cell)
    if number is None:
        return None
    if number != number.to_integral_value() or not low <= number <= high:
        raise CellError(f"expected a whole number from {low} to {high}, not {_short(cell.text)}")
    return int(number)


def identifier_of(cell: CellValue, *, hexadecimal: bool) -> int | None:
    """A CAN identifier in hexadecimal, with or without 0x; None where it is empty.

    A number without 0x is refused unless its column says that it is hexadecimal.
    """
    text = normal(text_of(cell))
    if not text:
        return None
    match = _HEX.fullmatch(text.replace(" ", ""))
    if match and cell.kind == "n" and not hexadecimal:
        raise CellError(f"{text} may be decimal or hexadecimal: write 0x… as text")
    if not match or int(match[1], 16) > 0x1FFF_FFFF:
        raise CellError(f"expected an identifier such as 0x18FF1234, not {_short(text)}")
    return int(match[1], 16)


def raw_of(cell: CellValue, *, length: int, signed: bool, hexadecimal: bool) -> int | None:
    """A raw value: 0x… as the bits of the signal, ``5 (dec)`` as it stands; None where empty.

    Digits alone are hexadecimal where the column says so.
    """
    text = normal(text_of(cell))
    if not text:
        return None
    if plain := _PLAIN_DECIMAL.fullmatch(text):
        return int(plain[1])
    compact = text.replace(" ", "")
    if re.fullmatch(r"[+-]?\d{1,20}", compact) and not hexadecimal:
        return int(compact)
    match = _HEX.fullmatch(compact)
    if not match:
        raise CellError(f"expected a raw value such as 0xFF, not {_short(text)}")
    return _from_bits(int(match[1], 16), length, signed=signed)


def raws_of(cell: CellValue, *, length: int, signed: bool, hexadecimal: bool) -> tuple[int, ...]:
    """Raw values in a list, ascending, each as `raw_of` reads it; none where the cell is empty."""
    parts = (part for part in re.split(r"[,;、，；\n]+", text_of(cell)) if part.strip())
    cells = (CellValue(cell.where, "s", part) for part in parts)
    found = [raw_of(each, length=length, signed=signed, hexadecimal=hexadecimal) for each in cells]
    values = sorted(value for value in found if value is not None)
    if len(set(values)) < len(values):
        raise CellError(f"a value stands twice in {_short(cell.text)}")
    return tuple(values)


def codes_of(text: str, *, length: int, signed: bool) -> dict[int, str]:
    """Codes and labels, one a line: ``0x0: Open``; a line without a code continues a label."""
    codes: dict[int, str] = {}
    for value, label in _code_lines(text):
        if plain := _PLAIN_DECIMAL.fullmatch(value):
            code = int(plain[1])
        elif value[:2].lower() == "0x":
            code = _from_bits(int(value, 16), length, signed=signed)
        else:
            code = int(value)
        if code in codes:
            raise CellError(f"code {value} stands here twice")
        codes[code] = _unquoted(label)
    return codes


def _code_lines(text: str) -> Iterator[tuple[str, str]]:
    value, label = "", ""
    for line in text.replace("\r\n", "\n").split("\n"):
        if match := _CODE_LINE.fullmatch(line):
            if value:
                yield value, label.strip()
            value, label = normal(match[1]), match[2]
        elif value:
            label += f"\n{line}"
        elif line.strip():
            raise CellError(f"expected a code and its label such as 0x0: Open, not {_short(line)}")
    if value:
        yield value, label.strip()


def _unquoted(label: str) -> str:
    if len(label) > 1 and label.startswith('"') and label.endswith('"'):
        try:
            inner = json.loads(label)
        except ValueError:
            return label
        return inner if isinstance(inner, str) else label
    return label


def _from_bits(value: int, length: int, *, signed: bool) -> int:
    half = 1 << (length - 1)
    return value - 2 * half if signed and half <= value < 2 * half else value


def multiplexing_of(text: str) -> tuple[bool, tuple[int, ...], str]:
    """Whether it selects, the selector values it needs, and the selector's name if it is given."""
    match = re.fullmatch(r"(?:[mM]([\d,\- ]+))?(M)?(?:\s*@\s*(\w+))?", normal(text))
    if not match:
        raise CellError(f"expected M, or m0 or m0-3,7 @Selector, not {_short(text)}")
    values: list[int] = []
    for part in (match[1] or "").replace(" ", "").split(","):
        bounds = re.fullmatch(r"(\d{1,10})(?:-(\d{1,10}))?", part)
        if part and bounds is None:
            raise CellError(f"expected M, or m0 or m0-3,7 @Selector, not {_short(text)}")
        if bounds:
            first, last = int(bounds[1]), int(bounds[2] or bounds[1])
            if not first <= last < first + 70_000 or len(values) > 70_000:
                raise CellError(f"{_short(part)} is no range of selector values")
            values.extend(range(first, last + 1))
    return bool(match[2]), tuple(values), match[3] or ""


def names_of(text: str) -> tuple[str, ...]:
    """Names or numbers in a list, however they are separated."""
    return tuple(part for part in re.split(r"[\s,;、，；]+", normal(text)) if part)


def _short(text: str) -> str:
    text = " ".join(text.split())
    return repr(text if len(text) <= 40 else f"{text[:40]}…")
