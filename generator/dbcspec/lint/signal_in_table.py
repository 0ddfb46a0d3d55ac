"""Rule signal-in-table: every signal of the annex is explained by a row of a signal table."""

from __future__ import annotations

from collections.abc import Iterator
from difflib import get_close_matches

from dbcspec.lint.rule import Found, Rule, Subject


def _check(subject: Subject) -> Iterator[Found]:
    if subject.spec is None:
        return
    explained = {row.name for _, row in subject.spec.rows()}
    rows = subject.spec.explanations()
    for message, field in subject.spec.fields():
        if not rows[message.name, field.name]:
            close = get_close_matches(field.name, explained, n=1)
            hint = f" (the closest is {close[0]})" if close else ""
            text = (
                f"no table explains {field.name} of {message.name}{hint}: correct the name, or add "
                f"a row"
            )
            yield Found(field.where_is("name"), field.name, text, message.name)


RULE = Rule("signal-in-table", "every signal of a message is explained by a table", _check)
