"""Rule dbc-form: the lines of a DBC file have the form that every reader takes."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.fix import repair_form
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.errors import Location


def _check(subject: Subject) -> Iterator[Found]:
    for repair in repair_form(subject.dbc_text or "")[1]:
        where = Location(subject.source, repair.line)
        yield Found(where, repair.fault, f"{repair}: --fix mends it")


RULE = Rule(
    "dbc-form",
    "the lines of a DBC file have the form that every reader takes",
    _check,
    level="warning",
)
