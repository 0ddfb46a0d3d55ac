"""The codes of signals to value tables, shared and named."""

from __future__ import annotations

from collections.abc import Mapping

from typedcan.model.naming import unused
from typedcan.model.protocol import Code, ValueTable

Codes = tuple[tuple[int, str], ...]
"""Raw values and their labels, ascending."""


class ValueTables:
    """Shares equal codes: under the name that the file gives them, else the first signal's."""

    def __init__(self, named: Mapping[str, Codes]) -> None:
        # Where two tables have the same codes, no file says which of them a signal has.
        self.named = bool(named) and len(set(named.values())) == len(named)
        self._tables = {name: _table(name, codes) for name, codes in named.items()}
        self._by_codes: dict[Codes, ValueTable] = {}
        for name, codes in named.items():
            self._by_codes.setdefault(codes, self._tables[name])

    def of(self, signal: str, codes: Codes) -> ValueTable:
        """The value table of a signal that has these codes."""
        if codes not in self._by_codes:
            name = unused(signal, self._tables)
            self._tables[name] = self._by_codes[codes] = _table(name, codes)
        return self._by_codes[codes]

    def all(self) -> tuple[ValueTable, ...]:
        """All value tables, those that the file names first."""
        return tuple(self._tables.values())


def _table(name: str, codes: Codes) -> ValueTable:
    return ValueTable(name, tuple(Code(code, text, text) for code, text in codes))


def codes_of(choices: Mapping[int, object]) -> Codes:
    """The choices that cantools has read."""
    return tuple(sorted((int(code), str(label)) for code, label in choices.items()))


def codes_labelled(codes: Codes, labels: frozenset[str], start: int) -> tuple[int, ...]:
    """The codes with such a label, first the one that is sent.

    Of several that is the one that the signal starts with, where it is one of them; else none is
    surely it, and none is given.
    """
    found = [code for code, label in codes if label.strip().lower() in labels]
    if len(found) > 1 and start not in found:
        return ()
    return tuple(sorted(found, key=lambda code: code != start))
