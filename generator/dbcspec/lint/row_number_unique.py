"""Rule row-number-unique: no table prints a row number twice; errata address rows by it."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.rule import Found, Rule, Subject
from dbcspec.spec.rows import SignalRow


def _check(subject: Subject) -> Iterator[Found]:
    for table in subject.spec.tables if subject.spec else ():
        first: dict[int, SignalRow] = {}
        for row in table.rows:
            other = first.setdefault(row.no, row)
            if other is not row:
                text = (
                    f"table {table.number} has row {row.no} at {other.where_is('no')} already: "
                    f"correct one by an erratum"
                )
                yield Found(row.where_is("no"), f"{table.stem}/{row.no}", text)


RULE = Rule("row-number-unique", "no table prints a row number twice", _check, level="warning")
