"""Rule signal-in-message: every row of a signal table means a signal of the annex."""

from __future__ import annotations

from collections.abc import Iterator
from difflib import get_close_matches

from dbcspec.lint.rule import Found, Rule, Subject


def _check(subject: Subject) -> Iterator[Found]:
    if subject.spec is None:
        return
    fields = {
        name
        for message, field in subject.spec.fields()
        for name in (field.name, f"{message.name}.{field.name}")
    }
    for table, row in subject.spec.rows():
        if not row.name:
            text = f"row {row.no} has no name: give it one by an erratum"
            yield Found(row.where, f"{table.stem}/{row.no}", text)
        elif row.signal not in fields:
            close = get_close_matches(row.signal, fields, n=1)
            hint = f" (the closest is {close[0]})" if close else ""
            text = f"no message has {row.signal}{hint}: correct the name, or add it to the annex"
            yield Found(row.where_is("name"), row.name, text)


RULE = Rule("signal-in-message", "every row of a table means a signal of a message", _check)
