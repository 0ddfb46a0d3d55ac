"""A row of the matrix to a signal."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from decimal import Decimal

from dbcspec.matrix.acting import acting_of
from dbcspec.matrix.grid import CellValue
from dbcspec.matrix.headings import normal
from dbcspec.matrix.row import Row
from dbcspec.matrix.values import (
    CellError,
    codes_of,
    decimal_of,
    multiplexing_of,
    names_of,
    raw_of,
    text_of,
    whole_of,
)
from typedcan.model.acting import usual_start
from typedcan.model.layout import float_limits
from typedcan.model.naming import unused
from typedcan.model.protocol import ByteOrder, Code, Signal, ValueTable

_MOST_BITS = 4_096
_MOST_START = 8 * 65_536
_NO_CODES: dict[int, str] = {}
_NOT_MULTIPLEXED: tuple[bool, tuple[int, ...], str] = (False, (), "")


class SharedTables:
    """Gives signals with the same codes and the same name of a table the same `ValueTable`."""

    def __init__(self) -> None:
        self._by_name: dict[str, ValueTable] = {}
        self._unnamed: dict[tuple[Code, ...], ValueTable] = {}

    def of(self, signal: str, name: str, codes: tuple[Code, ...]) -> ValueTable | None:
        """The table; one without a name, or whose name has other codes, is called as the signal."""
        if not codes:
            return None
        if name and self._by_name.setdefault(name, ValueTable(name, codes)).codes == codes:
            return self._by_name[name]
        if codes not in self._unnamed:
            free = unused(signal, self._by_name)
            self._unnamed[codes] = self._by_name[free] = ValueTable(free, codes)
        return self._unnamed[codes]

    def all(self) -> tuple[ValueTable, ...]:
        """Every table, in order of appearance."""
        return tuple(self._by_name.values())


def _labelled_alike(table: ValueTable | None, code: int | None) -> tuple[int, ...]:
    """The other codes with the label of this one."""
    labels = table.labels(english=False) if table else {}
    if code not in labels:
        return ()
    return tuple(each for each, label in labels.items() if each != code and label == labels[code])


@dataclass(slots=True)
class SignalDraft:
    """A signal's row, and the rows below it that go on with its codes."""

    row: Row
    senders: list[str]
    receivers: list[str]
    more: list[Row] = field(default_factory=list[Row])

    def signal(self, tables: SharedTables) -> Signal:
        """Read all cells; what cannot be read becomes a fault of the sheet."""
        row = self.row
        name = row.name("signal_name")
        length = self._needed("length", 1, _MOST_BITS)
        signed, is_float = row.read("data_type", _data_type, (False, False))
        factor = row.read("factor", decimal_of, None)
        if factor == 0:
            row.fault("factor", "a resolution of 0 loses every value")
            factor = None
        factor = Decimal(1) if factor is None else factor
        offset = row.read("offset", decimal_of, None) or Decimal(0)
        raw = {
            key: self._raw(key, length, signed=signed)
            for key in ("raw_minimum", "raw_maximum", "initial", "invalid", "abnormal")
        }
        given = _Given(length, factor, offset, signed, is_float)
        least, most = raw["raw_minimum"], raw["raw_maximum"]
        if factor < 0:
            least, most = most, least
        multiplexing = row.read("multiplexing", _multiplexing, _NOT_MULTIPLEXED)
        byte_order, start = self._place(length)
        acting = acting_of(row, length=length, signed=signed)
        initial = usual_start(None, acting) if raw["initial"] is None else raw["initial"]
        table = tables.of(name, row.name("value_table"), self._codes(length, signed=signed))
        return Signal(
            name=name,
            title=row.text("title"),
            english=row.text("english"),
            start=start,
            length=length,
            byte_order=byte_order,
            signed=signed,
            is_float=is_float,
            factor=factor,
            offset=offset,
            minimum=given.limit(row, "minimum", least, 0),
            maximum=given.limit(row, "maximum", most, 1),
            unit=row.text("unit"),
            value_table=table,
            invalid_code=raw["invalid"],
            other_invalid_codes=_labelled_alike(table, raw["invalid"]),
            abnormal_code=raw["abnormal"],
            start_value=initial,
            acting=acting,
            receivers=tuple(dict.fromkeys([*self.receivers, *names_of(row.text("receivers"))])),
            is_selector=multiplexing[0],
            multiplexer=multiplexing[2],
            selectors=multiplexing[1],
            reference=row.text("reference"),
            errata=names_of(row.text("errata")),
            where=row.where,
        )

    def _needed(self, key: str, low: int, high: int) -> int:
        before = len(self.row.sheet.faults)
        value = self.row.read(key, lambda cell: whole_of(cell, low, high), None)
        if value is None and len(self.row.sheet.faults) == before:
            what = {"length": "length", "start_bit": "start bit"}[key]
            self.row.fault(key, f"signal {self.row.name('signal_name')} has no {what}")
        return low if value is None else value

    def _raw(self, key: str, length: int, *, signed: bool) -> int | None:
        hexadecimal = self.row.is_hex(key)
        return self.row.read(
            key,
            lambda cell: raw_of(cell, length=length, signed=signed, hexadecimal=hexadecimal),
            None,
        )

    def _place(self, length: int) -> tuple[ByteOrder, int]:
        """Byte order, and the start bit as DBC files count it."""
        row = self.row
        start = self._needed("start_bit", 0, _MOST_START)
        if not row.sheet.has("byte_order"):
            return ByteOrder.INTEL, start
        order, from_lsb = row.read("byte_order", _byte_order, (ByteOrder.INTEL, False))
        if order is ByteOrder.MOTOROLA and from_lsb:
            start = _most_significant(start, length)
            if start < 0:
                row.fault("start_bit", "the signal would begin before the message")
        return order, max(0, start)

    def _codes(self, length: int, *, signed: bool) -> tuple[Code, ...]:
        printed = self._labels("codes", length, signed=signed)
        english = self._labels("english_codes", length, signed=signed)
        labels = {**english, **printed}
        return tuple(
            Code(value, labels[value], english.get(value, labels[value]))
            for value in sorted(labels)
        )

    def _labels(self, key: str, length: int, *, signed: bool) -> Mapping[int, str]:
        codes: dict[int, str] = {}
        for row in (self.row, *self.more):

            def read(cell: CellValue) -> dict[int, str]:
                return codes_of(text_of(cell), length=length, signed=signed)

            found = row.read(key, read, _NO_CODES)
            if twice := codes.keys() & found:
                row.fault(key, f"code {min(twice)} stands here twice")
            codes |= found
        return codes


@dataclass(frozen=True, slots=True)
class _Given:
    """What limits follow from."""

    length: int
    factor: Decimal
    offset: Decimal
    signed: bool
    is_float: bool

    def limit(self, row: Row, key: str, raw: int | None, side: int) -> Decimal:
        """A physical limit as given, else from the one on the bus, else what the bits can hold."""
        physical = row.read(key, decimal_of, None)
        if physical is not None:
            return physical
        if raw is not None:
            return raw * self.factor + self.offset
        if self.is_float:
            return float_limits(self.length)[side]
        values = 1 << self.length
        low = -(values // 2) if self.signed else 0
        ends = (low * self.factor + self.offset, (low + values - 1) * self.factor + self.offset)
        return sorted(ends)[side]


def _data_type(cell: CellValue) -> tuple[bool, bool]:
    """Whether it is signed, whether it is a float; nothing means unsigned."""
    text = normal(text_of(cell)).lower().replace(" ", "")
    if any(word in text for word in ("float", "double", "ieee", "single", "浮点")):
        return "unsigned" not in text, True
    if not text or text == "+" or "无符号" in text or text.startswith(("u", "bool", "enum")):
        return False, False
    if text == "-" or "有符号" in text or text.startswith(("signed", "sint", "int", "s")):
        return True, False
    raise CellError(f"expected Unsigned, Signed or Float, not {text!r}")


def _byte_order(cell: CellValue) -> tuple[ByteOrder, bool]:
    """The byte order, and whether start bits are those of the least significant bit."""
    text = normal(text_of(cell)).lower()
    if any(word in text for word in ("intel", "little", "小端")):
        return ByteOrder.INTEL, True
    if any(word in text for word in ("motorola", "big", "大端")):
        return ByteOrder.MOTOROLA, "lsb" in text
    raise CellError(f"expected Intel, Motorola MSB or Motorola LSB, not {text!r}")


def _most_significant(bit: int, length: int) -> int:
    """From the least significant bit of a Motorola signal up to its most significant one."""
    for _ in range(length - 1):
        bit = bit - 15 if bit % 8 == 7 else bit + 1
    return bit


def _multiplexing(cell: CellValue) -> tuple[bool, tuple[int, ...], str]:
    return multiplexing_of(text_of(cell))
