"""Rule english-codes-used: the English label of every row is the one that the files get.

Rows with the same printed codes share one value table, whose English labels come from one of
them: what the others say must be the same.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    tables = {
        tuple(table.labels(english=False).items()): table for table in subject.protocol.value_tables
    }
    for _, row in subject.spec.rows() if subject.spec else ():
        table = tables.get(tuple(sorted(row.labels.items())))
        english = table.labels() if table else {}
        for code, label in row.english_codes.items():
            if code not in row.labels:
                text = f"{row.name}: {label!r} is the English of code {code}, which is not printed"
            elif table and english[code] != label:
                text = (
                    f"{row.name}: the English of code {code} is {label!r}, but {english[code]!r} "
                    f"at {places.codes(table, code)}, where {table.name} gets its labels"
                )
            else:
                continue
            subject_name = row.name or f"{row.no}"
            yield Found(row.where_is("english_codes"), subject_name, f"{text}: correct one")


RULE = Rule("english-codes-used", "every English label of a row is used", _check, level="warning")
