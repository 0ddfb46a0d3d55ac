"""Code cells to shared, named value tables."""

from __future__ import annotations

from dbcspec.errors import Fault
from dbcspec.spec.rows import SignalRow, Spec
from typedcan.model.protocol import Code, ValueTable

_Codes = tuple[tuple[int, str], ...]


class ValueTables:
    """Gives signals with the same codes the same `ValueTable`, named by standard.yaml.

    Codes that standard.yaml names by no signal get the name of the first signal that has them. In
    another reading or edition, ``chosen``, names may have become those of one table: the first one
    is its name.
    """

    def __init__(self, spec: Spec, faults: list[Fault], *, chosen: bool = False) -> None:
        self._tables: dict[_Codes, ValueTable] = {}
        every = [row for _, row in reversed(list(spec.rows()))]
        rows = {**{row.name: row for row in every}, **{row.signal: row for row in every}}
        for name, signal in spec.standard.value_tables.items():
            where = spec.standard.where_is("value_tables")
            codes = _codes(rows[signal]) if signal in rows else ()
            if chosen and (not codes or codes in self._tables):
                continue
            if not codes:
                faults.append(Fault(where, f"{name}: no signal {signal!r} with codes"))
            elif codes in self._tables:
                same = self._tables[codes].name
                faults.append(Fault(where, f"{name} has the same codes as {same}"))
            else:
                self._tables[codes] = _table(name, rows[signal])

    def of(self, row: SignalRow) -> ValueTable | None:
        """The value table of a signal, None where it has no codes."""
        codes = _codes(row)
        if not codes:
            return None
        return self._tables.setdefault(codes, _table(row.name, row))

    def used(self) -> tuple[ValueTable, ...]:
        """All value tables, the named ones first."""
        return tuple(self._tables.values())


def _codes(row: SignalRow) -> _Codes:
    return tuple(sorted(row.labels.items()))


def _table(name: str, row: SignalRow) -> ValueTable:
    return ValueTable(
        name=name,
        codes=tuple(
            Code(value=value, label=label, english=row.english_codes.get(value, label))
            for value, label in _codes(row)
        ),
    )
